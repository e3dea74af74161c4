// Each wrong way to treat what lies outside the map gives its own artefact on the scene made for it; the right way
// none.

#include <algorithm>
#include <functional>

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

constexpr const char* kPassesHaveNoBorder = "a filter says itself what lies outside the maps of its own passes";

bool has_own_passes(const std::string& id) { return !catalogue().find(id).passes.empty(); }

class MapRange : public ::testing::TestWithParam<std::string> {};

TEST_P(MapRange, RightRule_LightsEverythingOutside) {
  EdgeScene edge;
  EXPECT_EQ(edge.dark(GetParam(), {}, is_outside), 0.0);
  EXPECT_EQ(edge.dark(GetParam(), {}, is_in_streak), 0.0);
  EXPECT_EQ(edge.dark(GetParam(), {}, is_beyond_far), 0.0);
  EXPECT_LT(edge.farthest_from(1.0, GetParam(), {}, is_outside), 1e-3);
}

TEST_P(MapRange, Repeat_TilesTheShadows) {
  if (has_own_passes(GetParam())) GTEST_SKIP() << kPassesHaveNoBorder;
  EdgeScene edge;
  const RangeRule repeat{Border::kRepeat, true, true};
  const auto inside = [](const Receiver& r) {
    return !is_beyond_far(r) && glm::all(glm::lessThan(glm::abs(r.uv - 0.5f), glm::vec2(0.45f)));
  };
  const double in_map = edge.dark(GetParam(), repeat, inside),
               tiled = edge.dark(GetParam(), repeat, is_outside_before_far);
  EXPECT_GT(in_map, 0.05);
  EXPECT_NEAR(tiled, in_map, 0.6 * in_map) << "as dark outside as inside, but for the views of the tiles";
}

TEST_P(MapRange, Edge_SmearsCastersAtTheEdgeAndNothingElse) {
  if (has_own_passes(GetParam())) GTEST_SKIP() << kPassesHaveNoBorder;
  EdgeScene edge;
  const RangeRule smeared{Border::kEdge, true, true};
  EXPECT_EQ(edge.dark(GetParam(), smeared, is_in_streak), 1.0);
  const double all = edge.dark(GetParam(), smeared, is_outside_before_far);
  EXPECT_GT(all, 0.01);
  EXPECT_LT(all, 0.1);
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

}  // namespace
}  // namespace shadowbench::test
