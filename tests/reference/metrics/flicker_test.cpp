#include "reference/metrics/flicker.h"

#include <gmock/gmock.h>

#include <cmath>
#include <limits>
#include <random>
#include <span>
#include <vector>

namespace shadowbench::metrics {
namespace {

using ::testing::DoubleNear;

TEST(Flicker, ChangeBetweenPlacesOfTheGrid_IsOverAllPairs) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const std::vector<float> a = {0.0f, 0.5f, 1.0f, 0.0f}, b = {0.3f, 0.5f, 0.0f, nan}, c = {0.6f, 0.5f, 0.0f, 0.0f};
  const std::vector<std::span<const float>> images = {a, b, c};
  const std::vector<std::uint8_t> mask = {1, 1, 0, 1};
  EXPECT_THAT(measure_change(images, 1, mask)->value, DoubleNear(std::sqrt((0.09 + 0.36 + 0.09) / 6.0), 1e-7));
  EXPECT_EQ(measure_change(std::vector<std::span<const float>>{b, b}, 1, mask)->value, 0.0);
  EXPECT_FALSE(measure_change(std::vector<std::span<const float>>{a}, 1, mask)) << "one place";
  EXPECT_FALSE(measure_change(std::vector<std::span<const float>>{a, b}, 2, mask)) << "one group";
  EXPECT_FALSE(measure_change(images, 1, std::vector<std::uint8_t>{0, 0, 0, 0})) << "no receiver";
}

/// Images of receivers that are lit where the sum of two random offsets of the grid is below a half; the second image
/// of a group is half a texel farther, and so the opposite.
std::vector<std::vector<float>> draw_groups(int groups, int of_group, std::mt19937& generator) {
  constexpr int kReceivers = 64;
  std::uniform_real_distribution<float> anywhere;
  std::vector<std::vector<float>> images;
  for (int g = 0; g < groups; ++g) {
    const float offset = anywhere(generator);
    for (int k = 0; k < of_group; ++k) {
      images.emplace_back();
      for (int i = 0; i < kReceivers; ++i) {
        const float at = static_cast<float>(i) / kReceivers + offset + 0.5f * static_cast<float>(k);
        images.back().push_back(at - std::floor(at) < 0.5f ? 1.0f : 0.0f);
      }
    }
  }
  return images;
}

/// Two independent offsets differ in a half of the receivers on average: sqrt(1/2), however many there are.
TEST(Flicker, ChangeDependsOnNoCountOfPlaces_AndIsWithinItsInterval) {
  const double expected = std::sqrt(0.5);
  for (const auto& [groups, of_group] : {std::pair(4, 1), std::pair(4, 2), std::pair(8, 2), std::pair(16, 2)}) {
    std::mt19937 generator(7);
    constexpr int kTrials = 300;
    double mean_square = 0.0;
    int covered = 0;
    for (int trial = 0; trial < kTrials; ++trial) {
      const auto images = draw_groups(groups, of_group, generator);
      const std::vector<std::span<const float>> spans(images.begin(), images.end());
      const Change change =
          *measure_change(spans, static_cast<std::size_t>(of_group), std::vector<std::uint8_t>(64, 1));
      mean_square += change.value * change.value / kTrials;
      covered += std::abs(change.value - expected) <= *change.reach ? 1 : 0;
    }
    EXPECT_NEAR(mean_square, 0.5, 0.03) << groups << " groups of " << of_group;
    EXPECT_GE(covered, 0.88 * kTrials) << groups << " groups of " << of_group;
  }
}

}  // namespace
}  // namespace shadowbench::metrics
