// The texture of blue noise: that it is noise, and that it is blue.

#include "filters/noise/blue_noise.h"

#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <functional>
#include <numbers>
#include <set>

#include "filters/random.h"

namespace shadowbench::filters {
namespace {

constexpr int kSide = static_cast<int>(kBlueNoiseSide);

using Turn = std::function<float(glm::ivec2)>;

/// The mean power of the frequencies whose distance from 0, in turns per texture, lies between two limits; white noise
/// of turns has 1 at all of them.
double measure_power(const Turn& turn, double from, double to) {
  const int reach = static_cast<int>(to);
  double power = 0.0;
  int frequencies = 0;
  for (int v = -reach; v <= reach; ++v) {
    for (int u = -reach; u <= reach; ++u) {
      if (const double distance = std::hypot(u, v); distance < from || distance >= to) continue;
      std::complex<double> sum;
      for (int i = 0; i < kSide * kSide; ++i) {
        const glm::ivec2 pixel(i % kSide, i / kSide);
        const double angle = 2.0 * std::numbers::pi * (u * pixel.x + v * pixel.y) / kSide;
        sum += (static_cast<double>(turn(pixel)) - 0.5) * std::polar(1.0, angle);
      }
      power += std::norm(sum) * 12.0 / (kSide * kSide);
      ++frequencies;
    }
  }
  return power / frequencies;
}

TEST(BlueNoise, HasEveryRankOnce) {
  const std::set<std::uint16_t> ranks(kBlueNoise.begin(), kBlueNoise.end());
  EXPECT_EQ(ranks.size(), kBlueNoise.size());
  EXPECT_EQ(*ranks.rbegin(), kBlueNoise.size() - 1);
}

TEST(BlueNoise, HasLittlePowerAtLowFrequencies) {
  const Turn blue = [](glm::ivec2 p) { return blue_noise_turn(p, 1); };
  const Turn white = [](glm::ivec2 p) { return random_turn(p, 1); };
  EXPECT_NEAR(measure_power(white, 1.0, 12.0), 1.0, 0.2);
  EXPECT_LT(measure_power(blue, 1.0, 4.0), 0.001);
  EXPECT_LT(measure_power(blue, 1.0, 12.0), 0.01);
  EXPECT_GT(measure_power(blue, 28.0, 32.0), 1.2);
}

TEST(BlueNoise, IsTheSameOnEveryMachine) {
  std::uint32_t hash = 0;
  for (const std::uint16_t rank : kBlueNoise) hash = hash_bits(hash + rank);
  EXPECT_EQ(hash, 1520271867u);
}

TEST(BlueNoise, Repeats_AndIsShiftedByTheSeed) {
  EXPECT_EQ(blue_noise_turn({3, 5}, 1), blue_noise_turn({3 + kSide, 5 + 2 * kSide}, 1));
  int moved = 0;
  for (int x = 0; x < kSide; ++x) moved += blue_noise_turn({x, 0}, 1) != blue_noise_turn({x, 0}, 2);
  EXPECT_GT(moved, kSide / 2);
}

}  // namespace
}  // namespace shadowbench::filters
