#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>

#include "harness/measure/timing.h"

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

TEST(MedianRatio, IsOneForEqualTimes_WithoutSpread) {
  const records::Ratio r = find_ratio({2.0, 3.0, 4.0}, {2.0, 3.0, 4.0});
  EXPECT_DOUBLE_EQ(r.median, 1.0);
  EXPECT_DOUBLE_EQ(r.ci95.low, 1.0);
  EXPECT_DOUBLE_EQ(r.ci95.high, 1.0);
}

TEST(MedianRatio, PairsRounds_SoThatCommonDriftCancels) {
  const records::Ratio r = find_ratio({2.0, 20.0, 200.0}, {1.0, 10.0, 100.0});
  EXPECT_DOUBLE_EQ(r.ci95.low, 2.0);
  EXPECT_DOUBLE_EQ(r.ci95.high, 2.0);
}

TEST(MedianRatio, OfMoreDenominators_TheFirstAreUsed) {
  EXPECT_DOUBLE_EQ(find_ratio({2.0, 4.0}, {1.0, 2.0, 1e9}).median, 2.0);
}

TEST(MedianRatio, OfOne_IsItself) {
  const records::Ratio r = find_ratio({3.0}, {2.0});
  EXPECT_EQ(r.ci95.low, 1.5);
  EXPECT_EQ(r.ci95.high, 1.5);
}

/// Times have a long tail: an exponential's, or one whose variance is infinite.
TEST(MedianInterval, HoldsTheTrueMedian_NinetyFiveTimesInAHundred) {
  std::mt19937_64 generator(5);
  std::normal_distribution<double> normal;
  std::exponential_distribution<double> exponential;
  std::student_t_distribution<double> heavy(2.0);
  const std::pair<std::function<double()>, double> kinds[] = {{[&] { return normal(generator); }, 0.0},
                                                              {[&] { return exponential(generator); }, std::log(2.0)},
                                                              {[&] { return heavy(generator); }, 0.0}};
  for (const auto& [draw, median] : kinds) {
    for (const std::size_t count : {3u, 4u, 5u, 6u, 7u, 8u, 10u, 15u, 40u, 100u}) {
      constexpr int kTrials = 4000;
      int covered = 0;
      for (int trial = 0; trial < kTrials; ++trial) {
        std::vector<double> values(count);
        std::ranges::generate(values, draw);
        const records::Interval interval = find_difference(values, std::vector<double>(count, 0.0)).ci95;
        covered += interval.low <= median && median <= interval.high ? 1 : 0;
      }
      EXPECT_GE(covered, 0.925 * kTrials) << count;
      EXPECT_LE(covered, 0.99 * kTrials) << count;
    }
  }
}

}  // namespace
}  // namespace shadowbench::measure
