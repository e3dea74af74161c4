#include "reference/metrics/z_test.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <vector>

namespace shadowbench::metrics {
namespace {

TEST(ZTest, StudentsQuantile_IsWhereItsTableHasIt) {
  // Student's t with 15 degrees of freedom: 2.131 is exceeded on both sides with probability 0.05.
  EXPECT_NEAR(find_p({2.131, 1.0, 15.0}), 0.05, 1e-4);
  EXPECT_NEAR(find_p({-4.262, 4.0, 15.0}), 0.05, 1e-4);
}

TEST(ZTest, NoVariance_MeansNoDifference) {
  EXPECT_EQ(find_p({0.0, 0.0, 15.0}), 1.0);
  EXPECT_EQ(find_p({1e-9, 0.0, 15.0}), 0.0);
}

TEST(ZTest, NotFinite_IsNoChance) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(find_p({nan, 1.0, 15.0}), 0.0);
  EXPECT_EQ(find_p(Share{nan, 16.0}, Share{8.0, 16.0}), 0.0);
}

TEST(ZTest, SharesOfTheTeaTastingLady_AreWhatFisherSays) {
  // Fisher 1935: all four cups of each kind told right has probability 1 in 70; twice that here.
  EXPECT_NEAR(find_p(Share{4.0, 4.0}, Share{0.0, 4.0}), 2.0 / 70.0, 1e-12);
  EXPECT_NEAR(find_p(Share{0.0, 4.0}, Share{4.0, 4.0}), 2.0 / 70.0, 1e-12);
  EXPECT_EQ(find_p(Share{2.0, 4.0}, Share{2.0, 4.0}), 1.0);
  EXPECT_EQ(find_p(Share{16.0, 16.0}, Share{256.0, 256.0}), 1.0);
}

TEST(ZTest, LevelIsCorrectedForTheNumberOfTests_AndTheWorstIsNamed) {
  std::vector<double> probabilities(100, 0.01);
  EXPECT_EQ(test_pixels({probabilities.data(), 1}, 0.05).beyond, 1);
  EXPECT_EQ(test_pixels(probabilities, 0.05).beyond, 0);
  probabilities[42] = 0.0004;
  const PixelTest test = test_pixels(probabilities, 0.05);
  EXPECT_EQ(test.beyond, 1);
  EXPECT_EQ(test.worst, 42u);
  EXPECT_DOUBLE_EQ(test.smallest_p, 0.0004);
  EXPECT_DOUBLE_EQ(test.corrected_level, 0.0005);
}

/// Whole pictures of chance must fail about as often as the level says, never much more.
TEST(ZTest, Chance_FailsAsOftenAsItsLevel) {
  std::mt19937 generator(1);
  std::student_t_distribution<double> chance(15.0);
  int failed = 0;
  constexpr int kPictures = 1000;
  for (int picture = 0; picture < kPictures; ++picture) {
    std::vector<double> pixels(200);
    for (double& p : pixels) p = find_p({chance(generator), 1.0, 15.0});
    if (test_pixels(pixels, 0.1).beyond > 0) ++failed;
  }
  // 95 expected (1 - (1 - 0.0005)^200), standard deviation 9.3.
  EXPECT_GT(failed, 58);
  EXPECT_LT(failed, 132);
}

TEST(ZTest, SumsAddVariances_AndDegreesOfFreedom) {
  const std::vector<NoisyDifference> equal(64, {0.5, 0.01, 15.0});
  const NoisyDifference sum = add_differences(equal);
  EXPECT_DOUBLE_EQ(sum.difference, 32.0);
  EXPECT_NEAR(sum.variance, 0.64, 1e-12);
  EXPECT_NEAR(sum.degrees_of_freedom, 960.0, 1e-9);
  const std::vector<NoisyDifference> one_counts = {{0.0, 1.0, 15.0}, {0.0, 1e-9, 15.0}};
  EXPECT_NEAR(add_differences(one_counts).degrees_of_freedom, 15.0, 1e-6);
}

}  // namespace
}  // namespace shadowbench::metrics
