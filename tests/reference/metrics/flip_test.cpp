#include "reference/metrics/flip.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <random>

namespace shadowbench::metrics {
namespace {

LinearPicture make_uniform(const glm::vec3& color, int width = 40, int height = 30) {
  return {width, height, std::vector<glm::vec3>(static_cast<std::size_t>(width * height), color)};
}

LinearPicture make_noise(unsigned seed) {
  std::mt19937 generator(seed);
  std::uniform_real_distribution<float> draw(0.0f, 1.0f);
  LinearPicture picture = make_uniform({0.0f, 0.0f, 0.0f});
  for (glm::vec3& pixel : picture.pixels) pixel = {draw(generator), draw(generator), draw(generator)};
  return picture;
}

std::vector<float> measure_flip(const LinearPicture& a, const LinearPicture& b,
                                double pixels_per_degree = kDefaultPixelsPerDegree) {
  return metrics::measure_flip(view_for_flip(a, pixels_per_degree), view_for_flip(b, pixels_per_degree));
}

double mean(const std::vector<float>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

TEST(Flip, EqualPictures_AreZero) {
  for (const float value : measure_flip(make_noise(1), make_noise(1))) EXPECT_EQ(value, 0.0f);
}

TEST(Flip, IsSymmetric_AndWithinZeroAndOne) {
  const std::vector<float> ab = measure_flip(make_noise(1), make_noise(2)),
                           ba = measure_flip(make_noise(2), make_noise(1));
  EXPECT_EQ(ab, ba);
  for (const float value : ab) {
    EXPECT_GE(value, 0.0f);
    EXPECT_LE(value, 1.0f);
  }
}

TEST(Flip, BlackAgainstWhite_IsWhatTheFormulaGivesByHand) {
  // Lightness differs by 100, chroma by 0: the difference is 100^0.7 = 25.119. The largest, green against blue, follows
  // from CIELAB: green (87.735, -86.183, 83.180), blue (32.297, 79.188, -107.860); Hunt: green (-75.613, 72.978), blue
  // (25.575, -34.836); HyAB = 55.438 + sqrt(101.188^2 + 107.814^2) = 203.30; ^0.7 = 41.276. The knee lies at 16.511, so
  // the value is 0.95 + 0.05 (25.119 - 16.511) / (41.276 - 16.511) = 0.96738. Uniform pictures have no features.
  for (const float value : measure_flip(make_uniform(glm::vec3(0.0f)), make_uniform(glm::vec3(1.0f))))
    EXPECT_NEAR(value, 0.96738f, 2e-4f);
}

TEST(Flip, GreenAgainstBlue_IsOne) {
  for (const float value : measure_flip(make_uniform({0.0f, 1.0f, 0.0f}), make_uniform({0.0f, 0.0f, 1.0f})))
    EXPECT_NEAR(value, 1.0f, 1e-5f);
}

TEST(Flip, CloseGreys_AreBelowTheKnee) {
  // Linear 0.2 and 0.21: L* 51.837 and 52.952, difference 1.1146^0.7 = 1.0789; 0.95 / 16.511 of it is 0.06208.
  const double value = mean(measure_flip(make_uniform(glm::vec3(0.2f)), make_uniform(glm::vec3(0.21f))));
  EXPECT_NEAR(value, 0.06208, 3e-4);
}

TEST(Flip, AnEdgeThatMoved_IsSeenMoreThanTheSameColourWithoutEdge) {
  LinearPicture a = make_uniform(glm::vec3(0.1f), 60, 40), b = a, flat = a;
  for (int y = 0; y < 40; ++y) {
    for (int x = 0; x < 60; ++x) {
      const auto i = static_cast<std::size_t>(y * 60 + x);
      if (x > 30) a.pixels[i] = glm::vec3(0.3f);
      if (x > 34) b.pixels[i] = glm::vec3(0.3f);
      flat.pixels[i] = glm::vec3(0.3f);
    }
  }
  const std::vector<float> moved = measure_flip(a, b);
  const std::vector<float> uniform = measure_flip(make_uniform(glm::vec3(0.1f), 60, 40), flat);
  EXPECT_GT(moved[20 * 60 + 32], uniform[20 * 60 + 32]);
  EXPECT_LT(moved[20 * 60 + 2], 1e-3f);
}

TEST(Flip, FartherAway_FineNoiseIsSeenLess) {
  EXPECT_LT(mean(measure_flip(make_noise(1), make_noise(2), 134.0)),
            mean(measure_flip(make_noise(1), make_noise(2), 67.0)));
}

}  // namespace
}  // namespace shadowbench::metrics
