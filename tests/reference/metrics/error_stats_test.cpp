#include "reference/metrics/error_stats.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

namespace shadowbench::metrics {
namespace {

TEST(ErrorStats, OfFourPixels_AreWhatTheirDefinitionsGive) {
  const std::vector<float> image = {0.5f, 1.0f, 0.0f, 0.25f, 0.9f}, truth = {0.0f, 1.0f, 0.5f, 0.0f, 0.0f};
  const std::vector<std::uint8_t> mask = {1, 1, 1, 1, 0};
  const auto stats = measure_error(image, truth, mask);
  ASSERT_TRUE(stats);
  EXPECT_EQ(stats->count, 4);
  EXPECT_DOUBLE_EQ(stats->mean, 0.0625);
  EXPECT_DOUBLE_EQ(stats->mae, 0.3125);
  EXPECT_DOUBLE_EQ(stats->rmse, std::sqrt((0.25 + 0.25 + 0.0625) / 4.0));
  EXPECT_DOUBLE_EQ(stats->max, 0.5);
  EXPECT_DOUBLE_EQ(stats->p95, 0.5);
}

TEST(ErrorStats, P95_LeavesFiveInAHundredAbove) {
  std::vector<float> image(100);
  for (std::size_t i = 0; i < 100; ++i) image[i] = static_cast<float>(i);
  const auto stats = measure_error(image, std::vector<float>(100, 0.0f), std::vector<std::uint8_t>(100, 1));
  EXPECT_DOUBLE_EQ(stats->p95, 94.0);
  EXPECT_DOUBLE_EQ(stats->max, 99.0);
}

TEST(ErrorStats, EqualImages_HaveNoError) {
  const std::vector<float> image = {0.1f, 0.9f};
  EXPECT_DOUBLE_EQ(measure_error(image, image, std::vector<std::uint8_t>{1, 1})->max, 0.0);
}

TEST(ErrorStats, NotFinitePixels_AreCountedAndLeftOut) {
  const std::vector<float> image = {std::numeric_limits<float>::quiet_NaN(), 0.5f}, truth = {0.0f, 0.0f};
  const auto stats = measure_error(image, truth, std::vector<std::uint8_t>{1, 1});
  EXPECT_EQ(stats->not_finite, 1);
  EXPECT_DOUBLE_EQ(stats->rmse, 0.5);
}

TEST(ErrorStats, EmptyMask_HasNone) {
  EXPECT_FALSE(measure_error(std::vector<float>{1.0f}, std::vector<float>{0.0f}, std::vector<std::uint8_t>{0}));
}

TEST(ErrorStats, TheTruthsVariance_IsTakenOffTheMeanSquareAlone) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const std::vector<float> image = {0.5f, 0.25f, nan, 1.0f}, truth = {0.0f, 0.0f, 0.0f, 0.0f};
  const std::vector<std::uint8_t> mask = {1, 1, 1, 0};
  const std::vector<float> variance = {0.0625f, 0.03125f, 9.0f, 9.0f}, more(4, 9.0f);
  const auto plain = measure_error(image, truth, mask), less = measure_error(image, truth, mask, variance);
  EXPECT_NEAR(less->rmse * less->rmse, plain->rmse * plain->rmse - 0.046875, 1e-12) << "of finite pixels that count";
  EXPECT_EQ(less->mae, plain->mae);
  EXPECT_EQ(less->max, plain->max);
  EXPECT_EQ(measure_error(image, truth, mask, more)->rmse, 0.0) << "never below nought";
}

}  // namespace
}  // namespace shadowbench::metrics
