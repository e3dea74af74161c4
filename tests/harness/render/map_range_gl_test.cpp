// Each wrong way to treat what lies outside the map gives its own artefact on the scene made for it; the right way
// none.

// What the GL computes of a receiver in a curved map is what the frustum says in double.

#include <algorithm>
#include <cmath>
#include <functional>

#include "harness/scene/mesh_tools.h"
#include "tests/harness/render/bench_fixture.h"

namespace shadowbench::test {
namespace {

using filters::Border;
using filters::RangeRule;
using filters::Receiver;

constexpr int kRangeMapSize = 256;
constexpr float kBeyondKernels = 12.0f / kRangeMapSize;  // no default kernel reaches this far from outside into the map

bool is_outside(const Receiver& r) {
  const glm::vec2 from_center = glm::abs(r.uv - 0.5f);
  return std::max(from_center.x, from_center.y) > 0.5f + kBeyondKernels;
}

bool is_beyond_far(const Receiver& r) { return r.depth_unbiased > 1.0f; }

/// The scene `edge` with every receiver known, those beyond the far plane too.
class EdgeScene {
 public:
  EdgeScene() : scene_(load_builtin("edge")), bench_(shared_context(), scene_, kRangeMapSize) {
    bench_.set_range({Border::kBorder, false, true});
    receivers_ = bench_.receivers(catalogue().parse_requests("none").front());
  }

  /// Gives the share of the receivers that `belongs` chooses which a filter makes darker than half lit.
  double dark(const std::string& filter, const RangeRule& rule, const std::function<bool(const Receiver&)>& belongs) {
    bench_.set_range(rule);
    const std::vector<float> image = bench_.draw(catalogue().parse_requests(filter).front());
    double dark = 0.0, all = 0.0;
    for (const Receiver& r : receivers_) {
      if (!belongs(r)) continue;
      all += 1.0;
      if (image[bench_.index(r)] < 0.5f) dark += 1.0;
    }
    EXPECT_GT(all, 200.0) << "the scene shows none of these receivers";
    return dark / all;
  }

  /// How far the darkest and the lightest of such receivers are from a visibility.
  double farthest_from(double visibility, const std::string& filter, const RangeRule& rule,
                       const std::function<bool(const Receiver&)>& belongs) {
    bench_.set_range(rule);
    const std::vector<float> image = bench_.draw(catalogue().parse_requests(filter).front());
    double farthest = 0.0;
    int count = 0;
    for (const Receiver& r : receivers_) count += belongs(r) ? 1 : 0;
    EXPECT_GT(count, 200) << "the scene shows none of these receivers";
    for (const Receiver& r : receivers_)
      if (belongs(r)) farthest = std::max(farthest, std::abs(visibility - static_cast<double>(image[bench_.index(r)])));
    return farthest;
  }

  Bench& bench() { return bench_; }
  std::size_t receivers() const { return receivers_.size(); }

 private:
  scene::Scene scene_;
  Bench bench_;
  std::vector<Receiver> receivers_;
};

bool is_outside_before_far(const Receiver& r) { return is_outside(r) && !is_beyond_far(r); }

/// On the terrace right of the beam, in line with it.
bool is_in_streak(const Receiver& r) {
  return is_outside_before_far(r) && std::abs(r.position_ws.z + 0.3f) < 0.1f && r.position_ws.x > 2.6f;
}

class MapRange : public ::testing::TestWithParam<std::string> {};

TEST_P(MapRange, RightRule_LightsEverythingOutside) {
  EdgeScene edge;
  EXPECT_EQ(edge.dark(GetParam(), {}, is_outside), 0.0);
  EXPECT_EQ(edge.dark(GetParam(), {}, is_in_streak), 0.0);
  EXPECT_EQ(edge.dark(GetParam(), {}, is_beyond_far), 0.0);
  EXPECT_LT(edge.farthest_from(1.0, GetParam(), {}, is_outside), 1e-3);
}

TEST_P(MapRange, NoFarTest_DarkensEverythingBeyond) {
  EdgeScene edge;
  const RangeRule compared{Border::kBorder, false, true};
  EXPECT_GT(edge.dark(GetParam(), compared, is_beyond_far), 0.99);
  EXPECT_EQ(edge.dark(GetParam(), compared, is_outside_before_far), 0.0);
}

std::vector<float> full_of_casters(float depth) {
  return std::vector<float>(std::size_t{kRangeMapSize} * kRangeMapSize, depth);
}

/// What is read beyond an edge shows where casters stand everywhere.
TEST_P(MapRange, MapFullOfCasters_DarkensNothingOutside) {
  EdgeScene edge;
  edge.bench().map().upload(full_of_casters(0.02f));
  EXPECT_LT(edge.farthest_from(1.0, GetParam(), {}, is_outside), 1e-3);
}

/// Series repeat themselves where a receiver lies farther behind its caster than the map is deep.
TEST_P(MapRange, NoFarTest_DarkensWhatIsBehindACaster_HoweverDeep) {
  const scene::Scene scene = load_builtin("stack");
  Bench bench(shared_context(), scene, kRangeMapSize, 160, 90);
  const filters::FilterRequest request = catalogue().parse_requests(GetParam()).front();
  render::LightLayers light = bench.light(request);
  for (int column = 0; column < 4; ++column) light.front().frustum.uv_depth_from_world[column].z *= 1.6f;
  light.front().range.far_test = false;
  bench.map().upload(full_of_casters(0.02f));
  render::FilterPasses passes(bench.shaders(), request, bench.map(), light);
  render::ImageTarget target("visibility", GL_R32F, 160, 90);
  passes.prefilter(bench.map());
  passes.lookup(bench.gbuffer(), bench.map(), target);
  const std::vector<float> image = target.texture().read_floats(1);
  int deep = 0;
  for (const Receiver& r : render::read_receivers(bench.shaders(), bench.gbuffer(), light.front())) {
    const bool is_inside = glm::all(glm::lessThan(glm::abs(r.uv - 0.5f), glm::vec2(0.5f - kBeyondKernels)));
    if (!is_inside || r.depth < 1.005f) continue;
    ++deep;
    EXPECT_LT(image[bench.index(r)], 0.01f) << "at depth " << r.depth;
  }
  EXPECT_GT(deep, 1000);
}

INSTANTIATE_TEST_SUITE_P(AllFilters, MapRange, ::testing::ValuesIn(filter_ids()),
                         [](const auto& each) { return each.param; });

TEST(MapRangeReceivers, LitByConvention_CountButAreNotAskedAbout) {
  EdgeScene edge;
  const auto request = catalogue().parse_requests("none").front();
  edge.bench().set_range({});
  const std::size_t asked = edge.bench().receivers(request).size();
  const auto counted =
      render::count_receivers(edge.bench().shaders(), edge.bench().gbuffer(), edge.bench().light(request));
  EXPECT_LT(asked, edge.receivers());
  EXPECT_EQ(static_cast<std::size_t>(counted), edge.receivers());
}

TEST(MapRangeVariants, RightRule_CompilesNothingMore) {
  const render::LightSetup right{};
  EXPECT_TRUE(render::range_defines(right).empty());
  render::LightSetup wrong{};
  wrong.range = {Border::kRepeat, false, false};
  EXPECT_EQ(render::range_defines(wrong).size(), 1u) << "an orthographic map has no behind";
}

/// Projected through the lamp, a deck over it lies in the mirrored cone: without the test of what is behind, the map is
/// asked about it, at depths before its near plane.
TEST(BehindALamp, ADeckIsNotAskedAbout_UnlessTheTestIsOff) {
  scene::Scene scene = load_builtin("lamp");
  scene.meshes.push_back(scene::make_plane({4.0f, 4.0f}, 1));
  for (scene::Vertex& v : scene.meshes.back().vertices) v.position_ws.y = 6.0f;
  scene.cameras = {look_down({-1.5f, 3.5f, 1.0f})};
  scene.cameras.front().forward_ws = {0.0f, 1.0f, 0.0f};  // sees the side that is turned to the lamp
  Bench bench(shared_context(), scene, kRangeMapSize);
  const auto request = catalogue().parse_requests("none").front();
  const auto find_deck = [&](const RangeRule& rule) {
    bench.set_range(rule);
    std::vector<Receiver> deck = bench.receivers(request);
    std::erase_if(deck, [](const Receiver& r) { return r.position_ws.y < 5.0f; });
    return deck;
  };
  EXPECT_EQ(find_deck({Border::kBorder, false, true}).size(), 0u);
  const std::vector<Receiver> deck = find_deck({Border::kBorder, false, false});
  EXPECT_GT(deck.size(), 1000u);
  EXPECT_TRUE(std::ranges::all_of(deck, [](const Receiver& r) { return r.depth < 0.0f; }));
}

constexpr int kShapeMap = 1024;

class CurvedMap : public ::testing::TestWithParam<std::string> {};

/// How a receiver's depth changes along its plane with one texel of u and of v, by steps on the plane.
glm::dvec2 step_on_plane(const scene::LightFrustum& frustum, const filters::Receiver& r) {
  const glm::dvec3 normal(r.normal_ws), position(r.position_ws);
  const glm::dvec3 side = glm::normalize(glm::cross(normal, glm::dvec3(0.6, 0.37, 0.71)));
  const double step = 1e-4 * static_cast<double>(r.texel_size_ws);
  glm::dmat2 texels;
  glm::dvec2 depths;
  for (int i = 0; i < 2; ++i) {
    const glm::dvec3 way = step * (i == 0 ? side : glm::cross(normal, side));
    const glm::dvec3 change = frustum.place(position + way, kShapeMap) - frustum.place(position - way, kShapeMap);
    texels[i] = glm::dvec2(change);
    depths[i] = change.z;
  }
  return depths * glm::inverse(texels);
}

TEST_P(CurvedMap, ReceiversLieWhereTheFrustumSays) {
  const scene::Scene scene = load_builtin(GetParam());
  Bench bench(shared_context(), scene, kShapeMap);
  double worst_texel = 0.0, worst_depth = 0.0, worst_size = 0.0, worst_plane = 0.0;
  int compared = 0, steep = 0;
  for (const filters::Receiver& r : bench.receivers(catalogue().parse_requests("none").front())) {
    if (r.layer_share == 0.0f) continue;
    const scene::LightFrustum& frustum = bench.layers()[static_cast<std::size_t>(r.layer)];
    const glm::dvec3 place = frustum.place(glm::dvec3(r.position_ws), kShapeMap);
    const double size = static_cast<double>(r.texel_size_ws), own = frustum.texel_size_at(glm::dvec3(r.position_ws));
    worst_texel = std::max(worst_texel, glm::distance(glm::dvec2(place), glm::dvec2(r.uv) * double{kShapeMap}));
    worst_depth = std::max(worst_depth, std::abs(place.z - static_cast<double>(r.depth_unbiased)));
    worst_size = std::max(worst_size, std::abs(size / own - 1.0));
    ++compared;
    if (r.n_dot_l < 0.05f) continue;  // rounding of the normal outweighs the slope
    const glm::dvec2 slope = step_on_plane(frustum, r);
    worst_plane = std::max(worst_plane, glm::distance(slope, glm::dvec2(r.depth_per_texel)) / glm::length(slope));
    ++steep;
  }
  std::printf("%s: %d receivers, %d with slopes; texels %.2g, depth %.2g, size %.2g, slope %.2g\n", GetParam().c_str(),
              compared, steep, worst_texel, worst_depth, worst_size, worst_plane);
  EXPECT_GT(steep, 10000);
  EXPECT_LT(worst_texel, 1e-3);
  EXPECT_LT(worst_depth, 1e-6);
  EXPECT_LT(worst_size, 1e-4);
  EXPECT_LT(worst_plane, 1e-4);
}

INSTANTIATE_TEST_SUITE_P(Shapes, CurvedMap,
                         ::testing::Values("lamp", "lantern", "avenue_by_focused", "avenue_by_lispsm", "avenue_by_psm",
                                           "avenue_by_tsm", "avenue_by_logpsm", "lantern_by_paraboloid"),
                         [](const auto& each) { return each.param; });

}  // namespace
}  // namespace shadowbench::test
