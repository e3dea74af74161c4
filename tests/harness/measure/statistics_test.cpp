#include "harness/measure/timing/statistics.h"

#include <gtest/gtest.h>

#include <random>

namespace shadowbench::measure {
namespace {

TEST(Summarise, GivesMedianAndQuartiles) {
  const records::Quartiles q = summarise({5.0, 1.0, 3.0, 2.0, 4.0});
  EXPECT_DOUBLE_EQ(q.median, 3.0);
  EXPECT_DOUBLE_EQ(q.q1, 2.0);
  EXPECT_DOUBLE_EQ(q.q3, 4.0);
  EXPECT_EQ(q.n, 5);
  EXPECT_DOUBLE_EQ(summarise({1.0, 2.0}).median, 1.5);
}

TEST(BootstrapRatio, IsOneForEqualTimes_WithoutSpread) {
  const records::Ratio r = bootstrap_ratio({2.0, 3.0, 4.0}, {2.0, 3.0, 4.0}, 1);
  EXPECT_DOUBLE_EQ(r.median, 1.0);
  EXPECT_DOUBLE_EQ(r.ci95.low, 1.0);
  EXPECT_DOUBLE_EQ(r.ci95.high, 1.0);
}

TEST(BootstrapRatio, PairsRounds_SoThatCommonDriftCancels) {
  const records::Ratio r = bootstrap_ratio({2.0, 20.0, 200.0}, {1.0, 10.0, 100.0}, 1);
  EXPECT_DOUBLE_EQ(r.ci95.low, 2.0);
  EXPECT_DOUBLE_EQ(r.ci95.high, 2.0);
}

TEST(BootstrapRatio, CoversTheTrueMedian_AboutNinetyFiveTimesInAHundred) {
  std::mt19937 generator(5);
  std::normal_distribution<double> noise(2.0, 0.1);
  int covered = 0;
  for (int trial = 0; trial < 300; ++trial) {
    std::vector<double> numerator(15), denominator(15, 1.0);
    for (double& value : numerator) value = noise(generator);
    const records::Ratio r = bootstrap_ratio(numerator, denominator, static_cast<std::uint64_t>(trial));
    covered += r.ci95.low <= 2.0 && 2.0 <= r.ci95.high ? 1 : 0;
  }
  EXPECT_GE(covered, 264);  // 88 %: four standard errors under 95 %, and a percentile interval of 15 is a bit short
  EXPECT_LT(covered, 300);
}

TEST(BootstrapRatio, OfMoreDenominators_TheFirstAreUsed) {
  EXPECT_DOUBLE_EQ(bootstrap_ratio({2.0, 4.0}, {1.0, 2.0, 1e9}, 1).median, 2.0);
}

/// 95 % and more, and not much more: the next narrower interval would cover less.
TEST(OrderRatio, CoversTheTrueMedian_AtLeastNinetyFiveTimesInAHundred) {
  std::mt19937 generator(5);
  std::normal_distribution<double> noise(2.0, 0.1);
  for (const std::size_t count : {6u, 9u, 15u, 100u}) {
    int covered = 0;
    constexpr int kTrials = 4000;
    for (int trial = 0; trial < kTrials; ++trial) {
      std::vector<double> numerator(count), denominator(count, 1.0);
      for (double& value : numerator) value = noise(generator);
      const records::Ratio r = order_ratio(numerator, denominator);
      covered += r.ci95.low <= 2.0 && 2.0 <= r.ci95.high ? 1 : 0;
    }
    EXPECT_GE(covered, 0.94 * kTrials) << count;  // three standard errors below 95 %
    EXPECT_LE(covered, 0.985 * kTrials) << count;
  }
  const records::Ratio all = order_ratio({3.0, 1.0, 2.0}, {1.0, 1.0, 1.0});
  EXPECT_EQ(all.ci95.low, 1.0);
  EXPECT_EQ(all.ci95.high, 3.0);
}

}  // namespace
}  // namespace shadowbench::measure
