#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "report/images/map_figures.h"

namespace shadowbench::images {
namespace {

/// A ramp on the left half, nothing on the right one.
Image make_depth_map(int side) {
  Image depth(side, side, 1);
  for (int y = 0; y < side; ++y)
    for (int x = 0; x < side; ++x)
      *depth.at(x, y) = x < side / 2 ? 0.2f + 0.5f * static_cast<float>(y) / static_cast<float>(side) : 1.0f;
  return depth;
}

std::size_t count_color(const Image& image, float r, float g, float b) {
  const auto near = [](float a, float c) { return std::abs(a - c) < 1e-5f; };
  std::size_t count = 0;
  for (std::size_t i = 0; i < image.texels.size(); i += 3)
    if (near(image.texels[i], r) && near(image.texels[i + 1], g) && near(image.texels[i + 2], b)) ++count;
  return count;
}

TEST(DepthHistogram, CountsEveryTexelOnce_EmptyOnesApart) {
  const DepthHistogram histogram = count_depths(make_depth_map(64), 10);
  EXPECT_EQ(histogram.empty, 64 * 32);
  EXPECT_EQ(std::accumulate(histogram.counts.begin(), histogram.counts.end(), std::int64_t{0}), 64 * 32);
  EXPECT_EQ(histogram.counts[1], 0);
  EXPECT_EQ(histogram.counts[7], 0);
  for (std::size_t bin = 2; bin < 7; ++bin)
    EXPECT_NEAR(static_cast<double>(histogram.counts[bin]), 64 * 32 / 5.0, 40.0) << bin;
}

TEST(DepthHistogram, DepthsOutsideTheRange_GoToTheNearestBin) {
  Image depth(2, 1, 1);
  depth.texels = {-0.5f, 2.0f};
  const DepthHistogram histogram = count_depths(depth, 4);
  EXPECT_EQ(histogram.counts, (std::vector<std::int64_t>{1, 0, 0, 1}));
}

Image draw_depth(const Image& stored, const filters::DepthCurve& curve) {
  return draw_figure({"map", "note", show_depth({{stored, 12.0}}, curve)});
}

TEST(DepthPicture, ShowsTheMapAndABarForEveryFilledBin) {
  const Image drawn = draw_depth(make_depth_map(256), {});
  EXPECT_EQ(count_color(drawn, 0.80f, 0.87f, 0.95f), 768u * 384u) << "the empty half";
  const std::size_t bars = count_color(drawn, 0.20f, 0.36f, 0.60f);
  EXPECT_GT(bars, 5000u);
  Image flat = make_depth_map(256);
  for (float& depth : flat.texels) depth = depth < 1.0f ? 0.4f : 1.0f;
  EXPECT_LT(count_color(draw_depth(flat, {}), 0.20f, 0.36f, 0.60f), bars / 20) << "one bin instead of many";
}

TEST(DepthPicture, MapThatDoesNotHoldLinearDepth_IsShownTwice_AsStoredAndLinearised) {
  const Image depth = make_depth_map(256);
  for (const filters::DepthCurve& curve :
       {filters::DepthCurve{true}, filters::DepthCurve{false, 50.0}, filters::DepthCurve{true, 50.0}}) {
    Image stored = depth;
    for (float& d : stored.texels) d = curve.store(d);
    const Figure figure{"map", "note", show_depth({{stored, 12.0}}, curve)};
    const Image drawn = draw_figure(figure);
    EXPECT_GT(drawn.width, 3 * draw_depth(depth, {}).width / 2);
    EXPECT_EQ(count_color(drawn, 0.80f, 0.87f, 0.95f), 2 * 768u * 384u) << "the empty half, twice";
    // The linearised map is that of the linear map, at the right.
    const std::vector<PlacedPicture> placed = layout_figure(figure).pictures;
    ASSERT_GE(placed.size(), 2u);
    EXPECT_EQ(placed[0].box.y, placed[1].box.y);
    EXPECT_GT(placed[1].box.x, placed[0].box.x + placed[0].box.width);
    const Stack linear = show_depth({{depth, 12.0}}, {}).front();
    const Image& once = linear.front().picture;
    ASSERT_EQ(placed[1].picture->texels.size(), once.texels.size());
    int different = 0;
    for (std::size_t i = 0; i < once.texels.size(); ++i)
      different += std::abs(placed[1].picture->texels[i] - once.texels[i]) > 0.01f ? 1 : 0;
    EXPECT_EQ(different, 0) << curve.reversed << curve.far_over_near;
  }
}

TEST(DensityPicture, MoreTexels_AnotherColour_AndSurfacesWithoutAreGrey) {
  Image density(4, 1, 1);
  density.texels = {0.1f, 10.0f, 0.0f, -1.0f};
  const Image drawn = draw_figure({"density", "", {show_density(density)}});
  EXPECT_EQ(count_color(drawn, 0.62f, 0.62f, 0.62f), 1u);
  EXPECT_EQ(count_color(drawn, 0.93f, 0.94f, 0.95f), 1u);
  // The pixels stand in a row, few texels blue, many red.
  const auto* grey = drawn.texels.data();
  while (!(grey[0] == 0.62f && grey[1] == 0.62f && grey[2] == 0.62f)) grey += 3;
  const float* few = grey - 6;
  const float* many = grey - 3;
  EXPECT_GT(few[2], few[0]);
  EXPECT_GT(many[0], many[2]);
}

/// A white picture, and where the map's texels lie on it.
struct Wall {
  Image picture;
  Image texel;
  Image density;
};

Image draw(const Wall& wall) {
  return draw_figure({"grid", "", {show_texels(wall.picture, wall.texel, wall.density)}});
}

/// A wall whose texels are `pixels` wide, white.
Wall make_wall(int side, float pixels) {
  Wall picture{Image(side, side, 3), Image(side, side, 2), Image(side, side, 1)};
  for (float& value : picture.picture.texels) value = 1.0f;
  for (int y = 0; y < side; ++y) {
    for (int x = 0; x < side; ++x) {
      picture.texel.at(x, y)[0] = static_cast<float>(x) / pixels;
      picture.texel.at(x, y)[1] = static_cast<float>(y) / pixels;
      *picture.density.at(x, y) = 1.0f / (pixels * pixels);
    }
  }
  return picture;
}

TEST(TexelGrid, DarkensEveryOtherTexel) {
  const Image drawn = draw(make_wall(64, 8.0f));
  EXPECT_EQ(count_color(drawn, 0.55f, 0.55f, 0.55f), 64u * 64u / 2u);
}

TEST(TexelGrid, SmallTexels_AreGatheredInFieldsThatShow) {
  EXPECT_EQ(choose_field_texels(make_wall(8, 8.0f).density), 1);
  EXPECT_EQ(choose_field_texels(make_wall(8, 1.0f).density), 8);
  EXPECT_EQ(choose_field_texels(Image(4, 4, 1)), 1) << "no receiver";
  const Image drawn = draw(make_wall(64, 1.0f));
  EXPECT_EQ(count_color(drawn, 0.55f, 0.55f, 0.55f), 64u * 64u / 2u);
  // Fields 8 pixels wide: along each of 64 rows 4 of them are dark, and have two sides.
  std::size_t sides = 0;
  for (std::size_t i = 3; i < drawn.texels.size(); i += 3) {
    const auto is_dark = [&](std::size_t at) {
      return std::abs(drawn.texels[at] - 0.55f) < 1e-5f && drawn.texels[at] == drawn.texels[at + 1];
    };
    sides += is_dark(i) != is_dark(i - 3) ? 1u : 0u;
  }
  EXPECT_EQ(sides, 64u * 4u * 2u);
}

TEST(TexelGrid, FieldsFarSmallerThanTheMedian_Fade) {
  Wall picture = make_wall(64, 8.0f);
  for (int y = 0; y < 16; ++y)
    for (int x = 0; x < 64; ++x) *picture.density.at(x, y) = 1.0f;
  EXPECT_EQ(count_color(draw(picture), 0.55f, 0.55f, 0.55f), 64u * 48u / 2u);
}

}  // namespace
}  // namespace shadowbench::images
