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

  /// How far the darkest and the lightest of such receivers are from wholly lit.
  double farthest_from_lit(const std::string& filter, const std::function<bool(const Receiver&)>& belongs) {
    bench_.set_range({});
    const std::vector<float> image = bench_.draw(catalogue().parse_requests(filter).front());
    double farthest = 0.0;
    for (const Receiver& r : receivers_)
      if (belongs(r)) farthest = std::max(farthest, std::abs(1.0 - static_cast<double>(image[bench_.index(r)])));
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
  EXPECT_LT(edge.farthest_from_lit(GetParam(), is_outside), 1e-3);
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
