#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "report/images/color_values.h"
#include "report/images/heat_figures.h"
#include "tests/report/records/synthetic.h"

namespace shadowbench::images {

using namespace records;
namespace {

Image make_constant(int side, float value) {
  Image image(side, side, 1);
  std::fill(image.texels.begin(), image.texels.end(), value);
  return image;
}

int count_stability_pixels(const Image& canvas, const images::Rgb& color) {
  int count = 0;
  for (std::size_t i = 0; i < canvas.texels.size(); i += 3) {
    bool equal = true;
    for (std::size_t c = 0; c < 3; ++c) equal = equal && std::abs(canvas.texels[i + c] - color[c]) < 0.5f / 255.0f;
    count += equal ? 1 : 0;
  }
  return count;
}

Image draw(const StabilityImages& images) {
  return draw_figure({"odd on cubes", "note", show_stability(images, {"a", "b", "c", "d"}), 2});
}

TEST(StabilityPicture, OnlyWhatExists_IsDrawn) {
  StabilityImages all;
  all.headroom = make_constant(64, 3.0f);
  const Image one = draw(all);
  all.variance = make_constant(64, 1e-6f);
  all.half_difference = make_constant(64, 0.1f);
  all.shortfall = all.violation = make_constant(64, 0.0f);
  const Image four = draw(all);
  EXPECT_GT(four.width, 2 * one.width - 100);
  EXPECT_GT(four.height, 2 * one.height - 180);
  const images::Rgb faint = map_diverging(-0.4f, 1.0f);  // a variance of 1e-6, four of ten decades from nothing
  EXPECT_LT(count_stability_pixels(one, faint), 1000);
  EXPECT_GE(count_stability_pixels(four, faint), 640 * 640);
}

/// One broken texel of a map that is reduced four times over must not be lost between the texels that are shown.
TEST(StabilityPicture, OneBrokenTexel_IsSeen) {
  for (const float broken : {-std::numeric_limits<float>::infinity(), std::numeric_limits<float>::quiet_NaN()}) {
    StabilityImages images;
    images.headroom = make_constant(2560, 3.0f);
    EXPECT_EQ(count_stability_pixels(draw(images), kMagenta), 0);
    *images.headroom.at(1002, 1502) = broken;
    EXPECT_EQ(count_stability_pixels(draw(images), kMagenta), 1);
  }
}

TEST(StabilityPicture, EmptyTexel_IsNotBroken) {
  StabilityImages images;
  images.headroom = make_constant(64, std::numeric_limits<float>::infinity());
  EXPECT_EQ(count_stability_pixels(draw(images), kMagenta), 0);
}

TEST(StabilityPicture, NegativeVariance_IsRed_AndTheLowestOfItsBlockIsShown) {
  StabilityImages images;
  images.variance = make_constant(1280, 1e-3f);
  const images::Rgb red = map_diverging(0.5f, 1.0f);  // -1e-5, half-way down ten decades
  const int of_bar = count_stability_pixels(draw(images), red);
  *images.variance.at(7, 9) = -1e-5f;
  const Image canvas = draw(images);
  EXPECT_EQ(count_stability_pixels(canvas, red), of_bar + 1);
  EXPECT_GT(count_stability_pixels(canvas, map_diverging(-0.7f, 1.0f)), 640 * 640 - 2);
}

TEST(StabilityPicture, UnexplainedShortfall_IsMagenta_ExplainedIsNot) {
  StabilityImages images;
  images.shortfall = make_constant(640, 0.1f);
  images.violation = make_constant(640, 0.0f);
  EXPECT_EQ(count_stability_pixels(draw(images), kMagenta), 0);
  for (int x = 0; x < 5; ++x) *images.violation.at(x, 3) = 0.01f;
  EXPECT_EQ(count_stability_pixels(draw(images), kMagenta), 5);
}

TEST(StabilityPicture, Difference_HasItsSign) {
  StabilityImages images;
  images.half_difference = make_constant(640, 0.1f);
  EXPECT_GE(count_stability_pixels(draw(images), map_diverging(0.1f, 0.1f)), 640 * 640);
}

}  // namespace
}  // namespace shadowbench::images
