#include <gtest/gtest.h>

#include <limits>

#include "report/images/color_values.h"

namespace shadowbench::images {
namespace {

TEST(Diverging, ZeroIsNeutral_EndsAreBlueAndRed_BeyondIsTheEnd) {
  const auto zero = map_diverging(0.0f, 0.5f), below = map_diverging(-0.5f, 0.5f), above = map_diverging(0.5f, 0.5f);
  EXPECT_NEAR(zero[0], zero[2], 0.02f);
  EXPECT_GT(below[2], below[0] + 0.3f);
  EXPECT_GT(above[0], above[2] + 0.3f);
  EXPECT_EQ(map_diverging(7.0f, 0.5f), above);
  EXPECT_EQ(map_diverging(-7.0f, 0.5f), below);
}

TEST(ErrorScale, IsTheTopOfTheErrors_RoundedUp) {
  Image image(100, 10, 1);
  for (std::size_t i = 0; i < 1000; ++i) image.texels[i] = i < 500 ? 0.0f : 0.0003f * static_cast<float>(i + 1);
  EXPECT_DOUBLE_EQ(choose_error_scale({&image}), 0.5);  // 95 % of the rest lie under 0.29
  image.texels[0] = std::numeric_limits<float>::quiet_NaN();
  EXPECT_DOUBLE_EQ(choose_error_scale({&image}), 0.5);
}

TEST(ErrorScale, RoundingErrorsAllOverAnImage_HaveNoSay) {
  Image image(100, 10, 1);
  std::fill(image.texels.begin(), image.texels.end(), 1e-7f);
  std::fill_n(image.texels.begin(), 10, 0.4f);
  EXPECT_DOUBLE_EQ(choose_error_scale({&image}), 0.5);
}

TEST(ErrorScale, OfNoError_IsTheSmallest) {
  const Image image(4, 4, 1);
  EXPECT_DOUBLE_EQ(choose_error_scale({&image}), 0.01);
}

}  // namespace
// The ends of viridis, as its authors give them for a display: (0.267, 0.005, 0.329) and (0.993, 0.906, 0.144).
TEST(ColorMaps, AreEncodedForADisplay) {
  const Image colors = color_values(make_ramp(2, 1), color_map("viridis"));
  const std::vector<float> ends = {0.267f, 0.005f, 0.329f, 0.993f, 0.906f, 0.144f};
  for (std::size_t i = 0; i < ends.size(); ++i) EXPECT_NEAR(colors.texels[i], ends[i], 0.002f);
}

}  // namespace shadowbench::images
