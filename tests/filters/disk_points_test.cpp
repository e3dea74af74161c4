#include "filters/disk_points.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace shadowbench::filters {
namespace {

struct Spread {
  double mean_square_radius = 0.0;
  double off_centre = 0.0;                              ///< distance of the mean from the centre
  double farthest = 0.0;                                ///< from the centre
  double closest = std::numeric_limits<double>::max();  ///< two points, in units of 1 / sqrt(count)
};

Spread measure(const std::vector<glm::vec2>& points) {
  Spread spread;
  glm::dvec2 mean(0.0);
  const double count = static_cast<double>(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const glm::dvec2 point(points[i]);
    mean += point / count;
    spread.mean_square_radius += glm::dot(point, point) / count;
    spread.farthest = std::max(spread.farthest, glm::length(point));
    for (std::size_t j = 0; j < i; ++j)
      spread.closest = std::min(spread.closest, std::sqrt(count) * glm::distance(point, glm::dvec2(points[j])));
  }
  spread.off_centre = glm::length(mean);
  return spread;
}

/// Uniform density has a mean square radius of 1/2, points of a hexagonal grid a distance of 1.9 / sqrt(count).
TEST(DiskPoints, AreUniformInDensity_CentredAndApart) {
  for (const int count : {4, 8, 16, 32, 100}) {
    for (const unsigned seed : {1u, 7u, 4294967295u}) {
      const Spread spread = measure(generate_disk_points(count, seed));
      EXPECT_NEAR(spread.mean_square_radius, 0.5, count < 8 ? 0.03 : 0.02) << count;
      EXPECT_LT(spread.off_centre, 1e-6) << count;
      EXPECT_LE(spread.farthest, 1.0 + 1e-6) << count;
      EXPECT_GT(spread.closest, 1.4) << count;
    }
  }
}

TEST(DiskPoints, AreTheSameOnEveryMachine) {
  const std::vector<glm::vec2> points = generate_disk_points(16, 1);
  EXPECT_NEAR(points[0].x, -0.1583503, 1e-6);
  EXPECT_NEAR(points[0].y, 0.1083270, 1e-6);
  EXPECT_NEAR(points[15].x, 0.7246058, 1e-6);
  EXPECT_NEAR(points[15].y, 0.6232137, 1e-6);
}

/// Of the points' spread, the mean over seeds; those of a pattern with chance differ from seed to seed.
Spread measure_mean(const std::string& pattern, int count) {
  constexpr unsigned kSeeds = 64;
  Spread mean{0.0, 0.0, 0.0, 0.0};
  for (unsigned seed = 1; seed <= kSeeds; ++seed) {
    const Spread spread = measure(generate_disk_points(count, seed, pattern));
    mean.mean_square_radius += spread.mean_square_radius / kSeeds;
    mean.off_centre = std::max(mean.off_centre, spread.off_centre);
    mean.farthest = std::max(mean.farthest, spread.farthest);
    mean.closest += spread.closest / kSeeds;
  }
  return mean;
}

TEST(DiskPoints, OfPatternsWithChance_AreUniformInTheMean) {
  for (const std::string pattern : {"stratified", "blue-noise"}) {
    for (const int count : {1, 4, 7, 8, 16, 32, 100}) {
      const Spread spread = measure_mean(pattern, count);
      EXPECT_LT(spread.off_centre, 1e-6) << pattern << " " << count;
      EXPECT_LE(spread.farthest, 1.0 + 1e-6) << pattern << " " << count;
      if (count >= 16) EXPECT_NEAR(spread.mean_square_radius, 0.5, 0.04) << pattern << " " << count;
    }
  }
}

TEST(DiskPoints, OfBlueNoise_AreApart) {
  for (const int count : {8, 16, 32, 100}) {
    const double closest = measure_mean("blue-noise", count).closest;
    EXPECT_GT(closest, 0.8) << count;
    EXPECT_GT(closest, 1.5 * measure_mean("stratified", count).closest) << count;
  }
}

TEST(DiskPoints, OfPatternsWithChance_AreTheSameOnEveryMachine) {
  const std::vector<glm::vec2> cells = generate_disk_points(16, 1, "stratified");
  EXPECT_LT(glm::distance(cells.front(), glm::vec2(-0.4621132f, -0.4561556f)), 1e-6f);
  EXPECT_LT(glm::distance(cells.back(), glm::vec2(0.4007884f, 0.4879614f)), 1e-6f);
  const std::vector<glm::vec2> apart = generate_disk_points(16, 1, "blue-noise");
  EXPECT_LT(glm::distance(apart.front(), glm::vec2(0.5017402f, 0.3007793f)), 1e-6f);
  EXPECT_LT(glm::distance(apart.back(), glm::vec2(0.8834952f, -0.1211787f)), 1e-6f);
}

TEST(DiskPoints, ASeedTurnsThem) {
  const std::vector<glm::vec2> one = generate_disk_points(16, 1), other = generate_disk_points(16, 2);
  EXPECT_NE(one, other);
  for (std::size_t i = 0; i < one.size(); ++i) EXPECT_NEAR(glm::length(one[i]), glm::length(other[i]), 1e-6);
}

TEST(DiskPoints, OnePoint_IsTheCentre) { EXPECT_EQ(generate_disk_points(1, 1).front(), glm::vec2(0.0f)); }

}  // namespace
}  // namespace shadowbench::filters
