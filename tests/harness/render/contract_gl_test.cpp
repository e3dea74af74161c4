// What every filter must do, whatever it is; a user's file keeps the same contract.

#include <cmath>
#include <cstring>

#include "filters/front_matter.h"
#include "harness/scene/primitives.h"
#include "harness/scene/validate.h"
#include "tests/harness/render/bench_fixture.h"

namespace shadowbench::test {
namespace {

using filters::FilterRequest;

filters::Catalogue catalogue_with_user_files() {
  filters::Catalogue all(run::find_resources().filters);
  const std::filesystem::path folder = std::filesystem::path(SHADOWBENCH_SOURCE_DIR) / "tests" / "user_filters";
  all.add_user_file(folder / "nine_compares.glsl");
  all.add_user_file(folder / "stored_plane.glsl");
  return all;
}

const filters::Catalogue& all_filters() {
  static const filters::Catalogue all = catalogue_with_user_files();
  return all;
}

std::vector<std::string> all_ids() {
  std::vector<std::string> ids;
  for (const auto& spec : all_filters().filters()) ids.push_back(spec.id);
  return ids;
}

FilterRequest request_of(const std::string& text) { return all_filters().parse_requests(text).front(); }

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
  scene.light.direction_ws = glm::normalize(glm::vec3(-0.1f, -1.0f, 0.05f));
  return scene::validate(scene, "floor");
}

class Contract : public ::testing::TestWithParam<std::string> {};

TEST_P(Contract, VisibilityIsWithinZeroAndOne) {
  const scene::Scene scene = load_builtin("stack");
  Bench bench(shared_context(), scene, 512, 320, 180);
  for (const float v : bench.draw(request_of(GetParam()))) {
    ASSERT_TRUE(std::isfinite(v));
    ASSERT_GE(v, 0.0f);
    ASSERT_LE(v, 1.0f);
  }
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

TEST_P(Contract, FullBlocker_IsDark) {
  const scene::Scene scene = floor_scene(true);
  Bench bench(shared_context(), scene, 256, 160, 90);
  const FilterRequest request = request_of(GetParam());
  const std::vector<float> image = bench.draw(request);
  const auto receivers = bench.receivers(request);
  ASSERT_GT(receivers.size(), 1000u);
  for (const auto& r : receivers) ASSERT_NEAR(image[bench.index(r)], 0.0f, 1e-3f) << r.pixel.x << "," << r.pixel.y;
}

TEST_P(Contract, SameInput_SameBits) {
  const scene::Scene scene = load_builtin("cubes");
  Bench first(shared_context(), scene, 256, 160, 90), second(shared_context(), scene, 256, 160, 90);
  const std::vector<float> a = first.draw(request_of(GetParam())), b = second.draw(request_of(GetParam()));
  EXPECT_EQ(std::memcmp(a.data(), b.data(), a.size() * sizeof(float)), 0);
}

/// Every parameter at each end of its range and at each of its choices.
std::vector<std::string> extreme_requests(const filters::FilterSpec& spec) {
  std::vector<std::string> texts;
  for (const filters::ParamSpec& param : spec.params) {
    std::vector<filters::ParamValue> values = param.choices;
    if (param.min) values.insert(values.end(), {*param.min, *param.max});
    if (std::holds_alternative<bool>(param.default_value)) values = {true, false};
    for (const auto& value : values) texts.push_back(spec.id + ":" + param.name + "=" + filters::to_string(value));
  }
  return texts;
}

TEST_P(Contract, ExtremeParameters_CompileAndDraw) {
  const scene::Scene scene = load_builtin("cubes");
  Bench bench(shared_context(), scene, 64, 64, 36);
  for (const std::string& text : extreme_requests(all_filters().find(GetParam()))) {
    EXPECT_NO_THROW(bench.draw(request_of(text))) << text;
  }
}

TEST_P(Contract, FetchCount_IsKnownUnlessTheFilterReadsSamplers) {
  const scene::Scene scene = load_builtin("cubes");
  Bench bench(shared_context(), scene, 64, 64, 36);
  const FilterRequest request = request_of(GetParam());
  render::FilterPasses passes(bench.shaders(), request, bench.map(), bench.light(request));
  passes.prefilter(bench.map());
  const render::FilterCost cost = passes.measure_cost(bench.shaders(), bench.gbuffer(), bench.map());
  EXPECT_EQ(cost.fetches.has_value(), !request.spec.uses_samplers);
  EXPECT_GE(cost.fetches.value_or(1.0), 1.0);
  EXPECT_EQ(cost.passes, request.spec.has_encode ? 5 : 2);
}

INSTANTIATE_TEST_SUITE_P(AllFilters, Contract, ::testing::ValuesIn(all_ids()),
                         [](const auto& each) { return each.param; });

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
  EXPECT_DOUBLE_EQ(fetches_of("poisson:taps=32"), 32.0);
  EXPECT_DOUBLE_EQ(fetches_of("nine_compares"), 9.0);
  EXPECT_DOUBLE_EQ(fetches_of("vsm"), 1.0);
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
