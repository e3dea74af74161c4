// What every filter must do, whatever it is; a user's file keeps the same contract.

#include <algorithm>
#include <cstring>

#include "harness/scene/mesh_tools.h"
#include "harness/scene/scene.h"
#include "tests/harness/render/contract_fixture.h"

namespace shadowbench::test {
namespace {

using filters::FilterKind;
using filters::FilterRequest;

/// A floor, seen from above; `roof` hangs over all of it where asked for.
scene::Scene floor_scene(bool roof) {
  scene::Scene scene;
  scene.name = "floor";
  scene.materials.emplace_back();
  scene.meshes.push_back(scene::make_plane({4.0f, 4.0f}, 8));
  if (roof) {
    scene.meshes.push_back(scene::make_plane({6.0f, 6.0f}, 8));
    for (scene::Vertex& v : scene.meshes.back().vertices) v.position_ws.y += 3.0f;
  }
  scene::Camera camera;
  camera.position_ws = {0.0f, 2.0f, 0.5f};
  camera.forward_ws = glm::normalize(glm::vec3(0.0f, -2.0f, -0.5f));
  camera.up_ws = {0.0f, 0.0f, -1.0f};
  scene.cameras.push_back(camera);
  scene.light.kind = scene::Sun{glm::normalize(glm::vec3(-0.1f, -1.0f, 0.05f))};
  return scene::validate(scene, "floor");
}

class Contract : public ::testing::TestWithParam<std::string> {};

/// Counts what no visibility can be: NaN, infinite, negative, over 1.
std::ptrdiff_t count_impossible(const std::vector<float>& image) {
  return std::ranges::count_if(
      image, [](float v) { return !(v >= 0.0f && v <= 1.0f); });
}

TEST_P(Contract, VisibilityIsWithinZeroAndOne) {
  const scene::Scene scene = load_builtin("stack");
  Bench bench(shared_context(), scene, 512, 320, 180);
  EXPECT_EQ(count_impossible(bench.draw(request_of(GetParam()))), 0);
}

TEST_P(Contract, NoOccluder_IsLit) {
  const scene::Scene scene = floor_scene(false);
  Bench bench(shared_context(), scene, 256, 160, 90);
  const FilterRequest request = request_of(GetParam());
  const std::vector<float> image = bench.draw(request);
  const auto receivers = bench.receivers(request);
  ASSERT_GT(receivers.size(), 1000u);
  for (const auto& r : receivers) ASSERT_NEAR(image[bench.index(r)], 1.0f, 1e-4f) << r.pixel.x << "," << r.pixel.y;
}

/// Of all kinds but `other`, which may do what they like under a blocker.
class Blocker : public ::testing::TestWithParam<std::string> {};

TEST_P(Blocker, OfTheWholeFloor_IsDark) {
  const scene::Scene scene = floor_scene(true);
  Bench bench(shared_context(), scene, 256, 160, 90);
  const FilterRequest request = request_of(GetParam());
  const std::vector<float> image = bench.draw(request);
  const auto receivers = bench.receivers(request);
  ASSERT_GT(receivers.size(), 1000u);
  for (const auto& r : receivers) ASSERT_NEAR(image[bench.index(r)], 0.0f, 1e-3f) << r.pixel.x << "," << r.pixel.y;
}

INSTANTIATE_TEST_SUITE_P(
    AllFilters, Blocker,
    ::testing::ValuesIn(ids_of({FilterKind::kComparison, FilterKind::kStochastic, FilterKind::kBound})), name_of);

TEST_P(Contract, SameInput_SameBits) {
  const scene::Scene scene = load_builtin("cubes");
  Bench first(shared_context(), scene, 256, 160, 90), second(shared_context(), scene, 256, 160, 90);
  const std::vector<float> a = first.draw(request_of(GetParam())), b = second.draw(request_of(GetParam()));
  EXPECT_EQ(std::memcmp(a.data(), b.data(), a.size() * sizeof(float)), 0);
}

/// Gives what a parameter may be driven to: the ends of its range, and all of its choices.
std::vector<filters::ParamValue> extreme_values(const filters::ParamSpec& param) {
  if (std::holds_alternative<bool>(param.default_value)) return {false, true};
  std::vector<filters::ParamValue> values = param.choices;
  if (param.min) values.push_back(*param.min);
  if (param.max) values.push_back(*param.max);
  return values;
}

/// Every parameter at each of its extremes, the others at their defaults; then all at their first, all at their last.
std::vector<std::string> extreme_requests(const filters::FilterSpec& spec) {
  std::vector<std::string> texts;
  std::string first = spec.id, last = spec.id;
  for (const filters::ParamSpec& param : spec.params) {
    const std::vector<filters::ParamValue> values = extreme_values(param);
    for (const auto& value : values) texts.push_back(spec.id + ":" + param.name + "=" + filters::to_string(value));
    if (values.empty()) continue;
    const std::string name = (first == spec.id ? ":" : ",") + param.name + "=";
    first += name + filters::to_string(values.front());
    last += name + filters::to_string(values.back());
  }
  texts.insert(texts.end(), {first, last});
  return texts;
}

TEST_P(Contract, ExtremeParameters_GiveVisibility) {
  const scene::Scene scene = load_builtin("cubes");
  Bench bench(shared_context(), scene, 64, 64, 36);
  for (const std::string& text : extreme_requests(all_filters().find(GetParam()))) {
    SCOPED_TRACE(text);
    EXPECT_NO_THROW(EXPECT_EQ(count_impossible(bench.draw(request_of(text))), 0));
  }
}

TEST_P(Contract, ReadsAreCounted_AndWithinTheDeclaredReach) {
  const scene::Scene scene = load_builtin("cubes");
  Bench bench(shared_context(), scene, 64, 64, 36);
  const FilterRequest request = request_of(GetParam());
  render::FilterPasses passes(bench.shaders(), request, bench.map(), bench.light(request));
  passes.prefilter(bench.map());
  const render::FilterCost cost = passes.measure_cost(bench.shaders(), bench.gbuffer(), bench.map());
  EXPECT_EQ(cost.fetches.has_value(), !request.spec.uses_samplers);
  EXPECT_GE(cost.fetches.value_or(1.0), 1.0);
  EXPECT_LE(cost.reach_texels.value_or(0.0), filters::reach_texels(request.spec, request.values) + 1e-3);
  EXPECT_EQ(cost.passes, 2 + passes.prefilter_passes());
  if (request.spec.passes.empty()) EXPECT_EQ(cost.passes, request.spec.has_encode ? 5 : 2);
}

INSTANTIATE_TEST_SUITE_P(AllFilters, Contract, ::testing::ValuesIn(ids_of()), name_of);

double fetches_of(const std::string& text) {
  const scene::Scene scene = load_builtin("cubes");
  Bench bench(shared_context(), scene, 64, 64, 36);
  const FilterRequest request = request_of(text);
  render::FilterPasses passes(bench.shaders(), request, bench.map(), bench.light(request));
  passes.prefilter(bench.map());
  return *passes.measure_cost(bench.shaders(), bench.gbuffer(), bench.map()).fetches;
}

TEST(FetchCount, EqualsTheFetchesInTheGlsl) {
  EXPECT_DOUBLE_EQ(fetches_of("none"), 1.0);
  EXPECT_DOUBLE_EQ(fetches_of("box3x3"), 9.0);
  EXPECT_DOUBLE_EQ(fetches_of("tent3x3"), 4.0);
  EXPECT_DOUBLE_EQ(fetches_of("teach4x4"), 4.0);
  EXPECT_DOUBLE_EQ(fetches_of("box4x4"), 4.0);
  EXPECT_DOUBLE_EQ(fetches_of("tent4x4"), 4.0);
  EXPECT_DOUBLE_EQ(fetches_of("tent5x5"), 9.0);
  EXPECT_DOUBLE_EQ(fetches_of("castano7"), 16.0);
  EXPECT_DOUBLE_EQ(fetches_of("gather_pcf:radius=3"), 16.0);
  EXPECT_DOUBLE_EQ(fetches_of("poisson:taps=32"), 32.0);
  EXPECT_DOUBLE_EQ(fetches_of("nine_compares"), 9.0);
  EXPECT_DOUBLE_EQ(fetches_of("vsm"), 1.0);
}

/// With every way to store depth, and with the receiver plane's depth in comparisons.
TEST(Gathers, AreTheFourTexelsOfAFetch) {
  const scene::Scene scene = load_builtin("fence");
  filters::Catalogue filters(options::find_resources().filters);
  filters.add_user_file(std::string(SHADOWBENCH_SOURCE_DIR) + "/tests/user_filters/gathers.glsl");
  const FilterRequest request = filters.parse_requests("gathers").front();
  for (const filters::DepthCurve& curve :
       {filters::DepthCurve{}, filters::DepthCurve{true, 1.0}, filters::DepthCurve{true, 100.0}}) {
    for (const char* bias : {"none", "receiver-plane"}) {
      Bench bench(shared_context(), scene, 256, 160, 90, {GL_DEPTH_COMPONENT32F, curve});
      const render::BiasRule rule = render::parse_bias({bias});
      const std::vector<float> image = bench.draw(request, rule);
      int differing = 0;
      for (const auto& r : bench.receivers(request, rule)) differing += image[bench.index(r)] != 1.0f;
      EXPECT_EQ(differing, 0) << bias << " " << render::describe_map(bench.map().settings());
    }
  }
}

TEST(Prefilter, WithoutEncode_CompilesAndRunsNothing) {
  const scene::Scene scene = load_builtin("cubes");
  Bench bench(shared_context(), scene, 64, 64, 36);
  const int before = bench.shaders().compiled();
  const FilterRequest request = request_of("none");
  const render::FilterPasses passes(bench.shaders(), request, bench.map(), bench.light(request));
  EXPECT_EQ(bench.shaders().compiled() - before, 1);
  EXPECT_FALSE(passes.has_prefilter());
}

}  // namespace
}  // namespace shadowbench::test
