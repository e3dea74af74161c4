#include "reference/metrics/map_stability.h"

#include <gmock/gmock.h>

#include <cmath>
#include <limits>

namespace shadowbench::metrics {
namespace {

using ::testing::ElementsAre;

constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

TEST(TexelHealth, CountsTexels_NotChannels) {
  const std::vector<float> values = {1.0f, kInfinity, kInfinity, -kInfinity, kNan, kInfinity, 2.0f, -3.0f};
  const TexelHealth health = check_texels({values, 2, 65504.0, false});
  EXPECT_EQ(health.texels, 4);
  EXPECT_EQ(health.overflowed, 2);
  EXPECT_EQ(health.nan, 1);
  EXPECT_EQ(health.broken(), 3);
  EXPECT_FALSE(health.largest) << "an overflowed map has no largest number";
  EXPECT_FALSE(health.negative_variance);
}

TEST(TexelHealth, LargestIsAMagnitude) {
  const std::vector<float> values = {1.0f, -3.0f, 2.0f};
  EXPECT_EQ(check_texels({values, 1, 65504.0, false}).largest, 3.0);
}

/// The warp of an exponential-variance map in both directions: two pairs, each with a variance.
TEST(TexelHealth, VarianceOfEveryPair_IsCounted) {
  const std::vector<float> values = {0.5f, 0.25f, 0.5f, 0.26f, 0.5f, 0.25f, 0.5f, 0.24f, 0.5f, 0.2f, kNan, 0.0f};
  const TexelHealth health = check_texels({values, 4, 65504.0, true});
  EXPECT_EQ(health.negative_variance, 1) << "the second; the third is NaN";
  EXPECT_FLOAT_EQ(static_cast<float>(*health.lowest_variance), 0.24f - 0.25f);
  const std::vector<float> variance = measure_variance({values, 4, 65504.0, true});
  EXPECT_FLOAT_EQ(variance[0], 0.0f);
  EXPECT_FLOAT_EQ(variance[1], 0.24f - 0.25f);
  EXPECT_TRUE(std::isnan(variance[2]));
}

/// A GL may saturate half floats instead of making them infinite; after the blur nothing looks wrong any more.
TEST(TexelHealth, Saturation_IsOverflow_AndReachesAsFarAsTheBlur) {
  std::vector<float> before(49, 1.0f), blurred(49, 900.0f);
  before[3 * 7 + 1] = 65504.0f;
  StoredMap map{blurred, 1, 65504.0, false, before, 2};
  const TexelHealth health = check_texels(map);
  EXPECT_EQ(health.overflowed, 4 * 5) << "columns 0 to 3 of rows 1 to 5";
  EXPECT_FALSE(health.largest);
  const std::vector<float> headroom = measure_headroom(map);
  EXPECT_EQ(headroom[5 * 7 + 3], -kInfinity);
  EXPECT_NEAR(headroom[5 * 7 + 4], std::log(65504.0 / 900.0), 1e-4);
  EXPECT_GT(headroom[6 * 7], 0.0f);
  before[3 * 7 + 1] = 65472.0f;
  EXPECT_EQ(check_texels(map).overflowed, 0);
  const float outside[] = {65504.0f};
  map.border = outside;
  EXPECT_EQ(check_texels(map).overflowed, 49 - 3 * 3) << "all whose blur reads what lies outside";
}

/// The two limits that everybody quotes: 11.09 in 16 bits, 88.72 in 32.
TEST(Headroom, OfOne_IsTheLargestExponent) {
  const std::vector<float> values = {1.0f, std::exp(4.0f), 0.0f, kInfinity, kNan};
  const std::vector<float> half = measure_headroom({values, 1, 65504.0, false});
  EXPECT_NEAR(half[0], 11.09f, 0.005f);
  EXPECT_NEAR(half[1], 7.09f, 0.005f);
  EXPECT_EQ(half[2], kInfinity);
  EXPECT_EQ(half[3], -kInfinity);
  EXPECT_TRUE(std::isnan(half[4]));
  EXPECT_NEAR(measure_headroom({values, 1, static_cast<double>(std::numeric_limits<float>::max()), false})[0], 88.72f,
              0.005f);
}

TEST(Bound, Darker_IsAViolationOnlyBeyondTheTolerance) {
  const std::vector<float> image = {0.5f, 0.5f, 0.5f, 0.7f, 0.1f, kNan};
  const std::vector<double> model = {0.6, 0.5, 0.6, 0.6, 0.1, 0.6}, closer(6, 0.6);
  const std::vector<double> tolerance = {0.2, 0.05, std::nan(""), 0.0, HUGE_VAL, 0.0};
  const BoundCheck check = check_bound({image, model, closer, tolerance});
  EXPECT_EQ(check.receivers, 4) << "neither the one without a receiver nor the one that is NaN";
  EXPECT_EQ(check.violations, 1);
  EXPECT_EQ(check.exact_violations, 2) << "the second and the fifth, whose models are darker too";
  EXPECT_NEAR(check.shortfall_max, 0.5, 1e-6);
  EXPECT_THAT(check.shortfall, ElementsAre(::testing::FloatNear(0.1f, 1e-6f), ::testing::FloatNear(0.1f, 1e-6f), 0.0f,
                                           0.0f, ::testing::FloatNear(0.5f, 1e-6f), 0.0f));
  EXPECT_THAT(check.violation, ElementsAre(0.0f, ::testing::FloatNear(0.05f, 1e-6f), 0.0f, 0.0f, 0.0f, 0.0f));
}

}  // namespace
}  // namespace shadowbench::metrics
