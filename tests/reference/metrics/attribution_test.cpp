// Errors taken apart: the parts add up, and shares follow from numbers that can be worked out by hand.

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "reference/metrics/error_stats.h"

namespace shadowbench::metrics {
namespace {

struct Stations {
  std::vector<float> image, kernel, area;
  std::vector<double> model, closer;
  std::vector<std::uint8_t> mask;

  void add(float i, double m, double c, float k, float a, bool counts = true) {
    image.push_back(i);
    model.push_back(m);
    closer.push_back(c);
    kernel.push_back(k);
    area.push_back(a);
    mask.push_back(counts ? 1 : 0);
  }
  Attribution attribute() const { return attribute_error({image, model, closer, kernel, area, mask}); }
};

TEST(Attribution, PartsAddUpToTheError_InEveryPixel) {
  std::mt19937 random(3);
  const auto draw = [&] { return static_cast<float>(random()) * 0x1p-32f; };
  Stations stations;
  for (int i = 0; i < 5000; ++i)
    stations.add(draw(), static_cast<double>(draw()), static_cast<double>(draw()), draw(), draw(), i % 7 != 0);
  const Attribution result = stations.attribute();
  for (std::size_t i = 0; i < 5000; ++i) {
    double sum = 0.0;
    for (const auto& part : result.parts) sum += static_cast<double>(part[i]);
    const double error =
        stations.mask[i] ? static_cast<double>(stations.image[i]) - static_cast<double>(stations.area[i]) : 0.0;
    ASSERT_NEAR(sum, error, 1e-6);
  }
  double shares = 0.0;
  for (const auto& stats : result.stats) shares += stats->share;
  EXPECT_NEAR(shares, 1.0, 1e-12);
}

TEST(Attribution, EachPartIsItsOwnDifference) {
  Stations stations;
  stations.add(0.9f, 0.8, 0.5, 0.25f, 0.125f);
  const Attribution result = stations.attribute();
  EXPECT_NEAR(result.parts[0][0], 0.1f, 1e-6f);
  EXPECT_NEAR(result.parts[1][0], 0.3f, 1e-6f);
  EXPECT_NEAR(result.parts[2][0], 0.25f, 1e-6f);
  EXPECT_NEAR(result.parts[3][0], 0.125f, 1e-6f);
}

TEST(Attribution, WithoutAModel_TheEstimatorsPartHoldsTheNumericOne) {
  Stations stations;
  stations.add(0.875f, 0.75, 0.5, 0.25f, 0.125f);
  stations.model.clear();
  const Attribution result = stations.attribute();
  EXPECT_TRUE(result.parts[0].empty());
  EXPECT_FALSE(result.stats[0]);
  EXPECT_EQ(result.parts[1][0], 0.375f);
  EXPECT_EQ(result.stats[1]->share, 0.5);
}

TEST(Attribution, TheKernelsVariance_IsTakenOffTheTwoPartsThatItIsIn) {
  Stations stations;
  stations.add(0.9f, 0.8, 0.5, 0.25f, 0.125f);
  stations.add(0.1f, 0.2, 0.5, 0.25f, 0.75f);
  stations.add(0.0f, 0.0, 0.0, 1.0f, 0.0f, false);
  const std::vector<float> variance = {0.01f, 0.02f, 9.0f};
  const Attribution plain = stations.attribute(),
                    less = attribute_error({stations.image, stations.model, stations.closer, stations.kernel,
                                            stations.area, stations.mask, variance});
  for (std::size_t p = 0; p < kErrorParts; ++p) {
    const double off = p < 2 ? 0.0 : 0.015, before = plain.stats[p]->rms, after = less.stats[p]->rms;
    EXPECT_NEAR(before * before - after * after, off, 1e-8) << p;
    EXPECT_EQ(plain.stats[p]->share, less.stats[p]->share) << p;
    EXPECT_EQ(plain.parts[p], less.parts[p]) << p;
  }
}

TEST(Attribution, SharesOfCancellingParts_AreNegative) {
  // Estimator +0.5 and model -0.25 in one pixel, nothing in the other: e = 0.25.
  Stations stations;
  stations.add(1.0f, 1.0, 0.5, 0.5f, 0.75f);
  stations.add(1.0f, 1.0, 1.0, 1.0f, 1.0f);
  const Attribution result = stations.attribute();
  EXPECT_NEAR(result.stats[1]->rms, 0.5 / std::sqrt(2.0), 1e-12);
  EXPECT_NEAR(result.stats[1]->share, 2.0, 1e-12);
  EXPECT_NEAR(result.stats[3]->share, -1.0, 1e-12);
  EXPECT_EQ(result.stats[0]->share, 0.0);
}

TEST(Attribution, WithoutError_HasNoShares) {
  Stations stations;
  stations.add(1.0f, 1.0, 1.0, 1.0f, 1.0f);
  stations.add(0.0f, 1.0, 1.0, 1.0f, 1.0f, false);
  EXPECT_FALSE(stations.attribute().stats[0]);
  EXPECT_FALSE(Stations().attribute().stats[0]);
}

TEST(Attribution, LeavesOutWhatIsNotFinite) {
  Stations stations;
  stations.add(std::numeric_limits<float>::quiet_NaN(), 1.0, 1.0, 1.0f, 1.0f);
  stations.add(0.5f, 0.5, 0.5, 0.5f, 0.25f);
  const Attribution result = stations.attribute();
  EXPECT_EQ(result.not_finite, 1);
  EXPECT_NEAR(result.stats[3]->rms, 0.25, 1e-12);
  EXPECT_EQ(result.parts[0][0], 0.0f);
}

}  // namespace
}  // namespace shadowbench::metrics
