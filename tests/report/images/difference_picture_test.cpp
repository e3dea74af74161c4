#include <gmock/gmock.h>

#include <limits>

#include "report/images/heat_figures.h"
#include "report/images/picture_io.h"
#include "tests/report/records/synthetic.h"

namespace shadowbench::images {
namespace {

/// How many pixels of a picture are clearly of one colour.
template <class IsColor>
long count_pixels(const Image& picture, IsColor is_color) {
  long count = 0;
  for (std::size_t i = 0; i + 2 < picture.texels.size(); i += 3)
    count += is_color(picture.texels[i], picture.texels[i + 1], picture.texels[i + 2]);
  return count;
}

TEST(DifferencePicture, ShowsBothSigns_WhatIsNotFinite_AndFlip) {
  const records::TemporaryFolder folder("difference_picture");
  Image difference(64, 32, 1);
  for (int x = 0; x < 64; ++x)
    for (int y = 0; y < 32; ++y) difference.at(x, y)[0] = x < 16 ? 0.1f : x < 24 ? -0.1f : 0.0f;
  write_figure(folder.path() / "a.png", {"a less b", "rmse 0.1", show_difference(difference, Image(64, 32, 1))});
  const Image a = read_picture(folder.path() / "a.png");
  const auto is_red = [](float r, float g, float b) { return r > 0.7f && g < 0.2f && b < 0.25f; };
  const auto is_blue = [](float r, float g, float b) { return b > 0.6f && r < 0.15f && g < 0.4f; };
  const auto is_magenta = [](float r, float g, float b) { return r > 0.99f && g < 0.01f && b > 0.99f; };
  EXPECT_GT(count_pixels(a, is_red), 640 * 320 / 5);
  EXPECT_GT(count_pixels(a, is_blue), 640 * 320 / 10);
  EXPECT_LT(count_pixels(a, is_blue), 640 * 320 / 5) << "red is where the first is larger";
  EXPECT_EQ(count_pixels(a, is_magenta), 0);
  difference.at(40, 20)[0] = std::numeric_limits<float>::quiet_NaN();
  difference.at(50, 20)[0] = std::numeric_limits<float>::infinity();
  write_figure(folder.path() / "b.png", {"a less b", "rmse 0.1", show_difference(difference, {})});
  const Image b = read_picture(folder.path() / "b.png");
  EXPECT_EQ(count_pixels(b, is_magenta), 100) << "a pixel is ten by ten";
  const auto is_grey = [](float r, float g, float blue) {
    return std::abs(r - 0.72f) < 0.01f && std::abs(g - 0.74f) < 0.01f && std::abs(blue - 0.77f) < 0.01f;
  };
  EXPECT_EQ(count_pixels(b, is_grey), 100) << "left out by the mask";
  EXPECT_LT(b.width, a.width) << "one panel";
}

}  // namespace
}  // namespace shadowbench::images
