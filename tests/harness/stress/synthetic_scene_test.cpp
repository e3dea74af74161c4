#include "harness/stress/synthetic_scene.h"

#include <gmock/gmock.h>

#include <limits>

#include "filters/kernel.h"

namespace shadowbench::stress {
namespace {

using ::testing::HasSubstr;

const Expected kRamp{{0.1, 0.4, 0.6, 0.9}, 0.02, 4};

TEST(Judge, IsOk_WithinTheBound) {
  const Observation seen = judge({{0.1, 0.41, 0.6, 0.9}, 0}, kRamp);
  EXPECT_EQ(seen.verdict, Verdict::kOk);
  EXPECT_NEAR(*seen.measured, 0.01, 1e-12);
}

TEST(Judge, IsDegraded_OverTheBound) {
  const Observation seen = judge({{0.1, 0.45, 0.6, 0.9}, 0}, kRamp);
  EXPECT_EQ(seen.verdict, Verdict::kDegraded);
  EXPECT_THAT(seen.why, HasSubstr("0.05"));
}

TEST(Judge, OverflownTexels_AreBroken_HoweverTheImageLooks) {
  const Observation seen = judge({kRamp.visibility, 3}, kRamp);
  EXPECT_EQ(seen.verdict, Verdict::kBroken);
  EXPECT_THAT(seen.why, HasSubstr("3 texels"));
}

TEST(Judge, NotFinite_IsBroken_WithNothingMeasured) {
  for (const double bad : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    const Observation seen = judge({{0.1, bad, 0.6, 0.9}, 0}, kRamp);
    EXPECT_EQ(seen.verdict, Verdict::kBroken);
    EXPECT_FALSE(seen.measured);
  }
}

TEST(Judge, AllLitOrAllDark_IsBroken_UnlessItShouldBe) {
  EXPECT_THAT(judge({{1.0, 1.0, 1.0, 1.0}, 0}, kRamp).why, HasSubstr("all 4 receivers are lit"));
  EXPECT_THAT(judge({{0.0, 0.0, 0.0, 0.0}, 0}, kRamp).why, HasSubstr("all 4 receivers are dark"));
  EXPECT_EQ(judge({{1.0, 1.0}, 0}, {{1.0, 1.0}, 0.02, 0}).verdict, Verdict::kOk);
}

TEST(Judge, FallsWithinARun_AreBroken_BetweenRunsTheyAreNot) {
  const Expected expected{{0.2, 0.8, 0.2, 0.8}, 0.5, 2};
  EXPECT_EQ(judge({{0.2, 0.8, 0.2, 0.8}, 0}, expected).verdict, Verdict::kOk);
  EXPECT_THAT(judge({{0.5, 0.35, 0.2, 0.8}, 0}, expected).why, HasSubstr("falls by 0.15"));
  EXPECT_EQ(judge({{0.5, 0.45, 0.2, 0.8}, 0}, expected).verdict, Verdict::kOk);  // less than kLargestFall
}

/// What the kernel of a receiver holds, read from the map itself.
double find_lit_share(const EdgeScene& edge, std::size_t i, int radius) {
  const std::vector<float> weights = filters::gaussian_weights(radius);
  const auto x = static_cast<int>(edge.scene.receivers[i].x * static_cast<float>(edge.scene.size));
  const auto y = static_cast<int>(edge.scene.receivers[i].y * static_cast<float>(edge.scene.size));
  double share = 0.0;
  for (int dy = -radius; dy <= radius; ++dy) {
    for (int dx = -radius; dx <= radius; ++dx) {
      const float depth = edge.scene.depths[static_cast<std::size_t>((y + dy) * edge.scene.size + x + dx)];
      const double weight = static_cast<double>(weights[static_cast<std::size_t>(dx + radius)] *
                                                weights[static_cast<std::size_t>(dy + radius)]);
      if (depth == edge.scene.receivers[i].z) share += weight;
    }
  }
  return share;
}

TEST(EdgeScene, Kernels_HoldTheShareThatIsSaid_OfTwoDepths) {
  for (const int radius : {1, 4, 9}) {
    const EdgeScene edge = make_edge_scene(radius, {{0.2f, 0.5f}, {0.3f, 0.6f}, {0.4f, 0.7f}});
    ASSERT_EQ(edge.lit_share.size(), 3 * edge.run);
    for (std::size_t i = 0; i < edge.lit_share.size(); ++i) {
      EXPECT_NEAR(find_lit_share(edge, i, radius), edge.lit_share[i], 1e-6) << radius << " " << i;
      EXPECT_GT(edge.lit_share[i], 0.0);
      EXPECT_LT(edge.lit_share[i], 1.0);
      if (i % edge.run == 0) continue;
      EXPECT_GT(edge.lit_share[i], edge.lit_share[i - 1]);
    }
  }
}

TEST(EdgeScene, WithoutABlur_ReceiversStandBetweenTwoTexels) {
  const EdgeScene edge = make_edge_scene(0, {{0.2f, 0.5f}});
  for (std::size_t i = 0; i < edge.lit_share.size(); ++i) {
    const double texels = static_cast<double>(edge.scene.receivers[i].x) * edge.scene.size - 0.5;
    EXPECT_NEAR(texels - (edge.scene.size / 2 - 1), edge.lit_share[i], 1e-5);
  }
}

/// A box of 7 texels beside an edge d texels away holds 1/2 + d / 7 of what lies on this side.
TEST(EdgeScene, OfABox_HoldsTheShareOfItsAreaAcrossTheEdge) {
  const EdgeScene edge = make_edge_scene(filters::Kernel::make_box(7), {{0.2f, 0.5f}, {0.3f, 0.6f}});
  ASSERT_EQ(edge.lit_share.size(), 2 * edge.run);
  EXPECT_GT(edge.run, 20u);
  for (std::size_t i = 0; i < edge.lit_share.size(); ++i) {
    const double offset = static_cast<double>(edge.scene.receivers[i].x) * edge.scene.size - edge.scene.size / 2;
    EXPECT_NEAR(edge.lit_share[i], 0.5 + offset / 7.0, 1e-5) << i;
    EXPECT_GT(edge.lit_share[i], 0.0);
    EXPECT_LT(edge.lit_share[i], 1.0 - 1e-9) << "the other depth is not in this kernel";
  }
}

}  // namespace
}  // namespace shadowbench::stress
