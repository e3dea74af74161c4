#include "report/images/heat_figures.h"

#include "report/images/crop.h"
#include "report/images/picture_io.h"
#include "report/images/text.h"
#include "tests/report/records/synthetic.h"

namespace shadowbench::images {
namespace {

using namespace records;

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
  Image image = fill(Image(100, 10, 1), 1e-7f);
  std::fill_n(image.texels.begin(), 10, 0.4f);
  EXPECT_DOUBLE_EQ(choose_error_scale({&image}), 0.5);
}

TEST(ErrorScale, OfNoError_IsTheSmallest) {
  const Image image(4, 4, 1);
  EXPECT_DOUBLE_EQ(choose_error_scale({&image}), 0.01);
}

// The ends of viridis, as its authors give them for a display: (0.267, 0.005, 0.329) and (0.993, 0.906, 0.144).
TEST(ColorMaps, AreEncodedForADisplay) {
  const Image colors = color_values(make_ramp(2, 1), color_map("viridis"));
  const std::vector<float> ends = {0.267f, 0.005f, 0.329f, 0.993f, 0.906f, 0.144f};
  for (std::size_t i = 0; i < ends.size(); ++i) EXPECT_NEAR(colors.texels[i], ends[i], 0.002f);
}

Image make_constant(int side, float value) { return fill(Image(side, side, 1), value); }

/// Pixels of a colour, to half a code of 8 bits.
int count_color(const Image& image, const Rgb& color) {
  int count = 0;
  for (std::size_t i = 0; i < image.texels.size(); i += 3)
    count += std::equal(color.begin(), color.end(), &image.texels[i],
                        [](float a, float b) { return std::abs(a - b) < 0.5f / 255.0f; });
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
  EXPECT_LT(count_color(one, faint), 1000);
  EXPECT_GE(count_color(four, faint), 640 * 640);
}

/// One broken texel of a map that is reduced four times over must not be lost between the texels that are shown.
TEST(StabilityPicture, OneBrokenTexel_IsSeen) {
  for (const float broken : {-std::numeric_limits<float>::infinity(), std::numeric_limits<float>::quiet_NaN()}) {
    StabilityImages images;
    images.headroom = make_constant(2560, 3.0f);
    EXPECT_EQ(count_color(draw(images), kMagenta), 0);
    *images.headroom.at(1002, 1502) = broken;
    EXPECT_EQ(count_color(draw(images), kMagenta), 1);
  }
}

TEST(StabilityPicture, EmptyTexel_IsNotBroken) {
  StabilityImages images;
  images.headroom = make_constant(64, std::numeric_limits<float>::infinity());
  EXPECT_EQ(count_color(draw(images), kMagenta), 0);
}

TEST(StabilityPicture, NegativeVariance_IsRed_AndTheLowestOfItsBlockIsShown) {
  StabilityImages images;
  images.variance = make_constant(1280, 1e-3f);
  const images::Rgb red = map_diverging(0.5f, 1.0f);  // -1e-5, half-way down ten decades
  const int of_bar = count_color(draw(images), red);
  *images.variance.at(7, 9) = -1e-5f;
  const Image canvas = draw(images);
  EXPECT_EQ(count_color(canvas, red), of_bar + 1);
  EXPECT_GT(count_color(canvas, map_diverging(-0.7f, 1.0f)), 640 * 640 - 2);
}

TEST(StabilityPicture, UnexplainedShortfall_IsMagenta_ExplainedIsNot) {
  StabilityImages images;
  images.shortfall = make_constant(640, 0.1f);
  images.violation = make_constant(640, 0.0f);
  EXPECT_EQ(count_color(draw(images), kMagenta), 0);
  for (int x = 0; x < 5; ++x) *images.violation.at(x, 3) = 0.01f;
  EXPECT_EQ(count_color(draw(images), kMagenta), 5);
}

TEST(StabilityPicture, Difference_HasItsSign) {
  StabilityImages images;
  images.half_difference = make_constant(640, 0.1f);
  EXPECT_GE(count_color(draw(images), map_diverging(0.1f, 0.1f)), 640 * 640);
}

TEST(DifferencePicture, ShowsBothSigns_WhatIsNotFinite_AndFlip) {
  const TestFolder folder;
  Image difference(64, 32, 1);
  for (int x = 0; x < 64; ++x)
    for (int y = 0; y < 32; ++y) difference.at(x, y)[0] = x < 16 ? 0.1f : x < 24 ? -0.1f : 0.0f;
  write_figure(folder.path() / "a.png", {"a less b", "rmse 0.1", show_difference(difference, Image(64, 32, 1))});
  const Image a = read_picture(folder.path() / "a.png");
  const auto scale = static_cast<float>(choose_error_scale({&difference}));
  const Rgb red = map_diverging(0.1f, scale), blue = map_diverging(-0.1f, scale);
  EXPECT_GT(count_color(a, red), 640 * 320 / 5);
  EXPECT_GT(count_color(a, blue), 640 * 320 / 10);
  EXPECT_LT(count_color(a, blue), 640 * 320 / 5) << "red is where the first is larger";
  EXPECT_EQ(count_color(a, kMagenta), 0);
  difference.at(40, 20)[0] = std::numeric_limits<float>::quiet_NaN();
  difference.at(50, 20)[0] = std::numeric_limits<float>::infinity();
  write_figure(folder.path() / "b.png", {"a less b", "rmse 0.1", show_difference(difference, {})});
  const Image b = read_picture(folder.path() / "b.png");
  EXPECT_EQ(count_color(b, kMagenta), 100) << "a pixel is ten by ten";
  EXPECT_EQ(count_color(b, {0.72f, 0.74f, 0.77f}), 100) << "left out by the mask";
  EXPECT_LT(b.width, a.width) << "one panel";
}

/// A ramp on the left half, nothing on the right one.
Image make_depth_map(int side) {
  Image depth(side, side, 1);
  for (int y = 0; y < side; ++y)
    for (int x = 0; x < side; ++x)
      *depth.at(x, y) = x < side / 2 ? 0.2f + 0.5f * static_cast<float>(y) / static_cast<float>(side) : 1.0f;
  return depth;
}

Image draw_depth(const Image& stored, const filters::DepthCurve& curve) {
  return draw_figure({"map", "note", show_depth({{stored}}, curve)});
}

TEST(DepthPicture, ShowsTheMap_AndCountsWhatIsEmpty) {
  const Stack stack = show_depth({{make_depth_map(256)}}, {}).front();
  EXPECT_THAT(stack.at(0).words, HasSubstr("blue: nothing drawn, 32768 of 65536 texels"));
  EXPECT_EQ(count_color(stack.at(0).picture, {0.80f, 0.87f, 0.95f}), 768 * 384) << "the empty half";
}

TEST(DepthPicture, MapThatDoesNotHoldLinearDepth_IsShownTwice_AsStoredAndLinearised) {
  const Image depth = make_depth_map(256);
  for (const filters::DepthCurve& curve :
       {filters::DepthCurve{true}, filters::DepthCurve{false, 50.0}, filters::DepthCurve{true, 50.0}}) {
    Image stored = depth;
    for (float& d : stored.texels) d = curve.store(d);
    const Figure figure{"map", "note", show_depth({{stored}}, curve)};
    const Image drawn = draw_figure(figure);
    EXPECT_GT(drawn.width, 3 * draw_depth(depth, {}).width / 2);
    EXPECT_EQ(count_color(drawn, {0.80f, 0.87f, 0.95f}), 2 * 768 * 384) << "the empty half, twice";
    // The linearised map is that of the linear map, at the right.
    const std::vector<PlacedPicture> placed = layout_figure(figure).pictures;
    ASSERT_GE(placed.size(), 2u);
    EXPECT_EQ(placed[0].box.y, placed[1].box.y);
    EXPECT_GT(placed[1].box.x, placed[0].box.x + placed[0].box.width);
    const Stack linear = show_depth({{depth}}, {}).front();
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
  EXPECT_EQ(count_color(drawn, {0.62f, 0.62f, 0.62f}), 1);
  EXPECT_EQ(count_color(drawn, {0.93f, 0.94f, 0.95f}), 1);
  // The pixels stand in a row, few texels blue, many red.
  const auto* grey = drawn.texels.data();
  while (!(grey[0] == 0.62f && grey[1] == 0.62f && grey[2] == 0.62f)) grey += 3;
  const float* few = grey - 6;
  const float* many = grey - 3;
  EXPECT_GT(few[2], few[0]);
  EXPECT_GT(many[0], many[2]);
}

// Lit right of x = 20 and right of x = 60; blocked between 40 and 60.
Image make_two_edges() {
  Image image(80, 40, 1);
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) *image.at(x, y) = (x >= 20 && x < 40) || x >= 60 ? 1.0f : 0.0f;
  return image;
}

bool contains(const Rect& rect, int x, int y) {
  return x >= rect.x && x < rect.x + rect.width && y >= rect.y && y < rect.y + rect.height;
}

/// Visibility with two edges, and a copy that each test changes.
class HardestEdge : public ::testing::Test {
 protected:
  const Image reference_ = make_two_edges();
  Image other_ = reference_;
};

TEST_F(HardestEdge, TheEdgeThatFiltersDisagreeOn_IsFound) {
  for (int y = 25; y < 30; ++y) {
    *other_.at(60, y) = 0.4f;
    *other_.at(59, y) = 0.6f;
  }
  const Rect crop = find_disputed_edge({&reference_, &other_}, 0, {12, 9});
  EXPECT_TRUE(contains(crop, 59, 25));
  EXPECT_TRUE(contains(crop, 60, 29));
  EXPECT_EQ(crop.width, 12);
  EXPECT_EQ(crop.height, 9);
}

TEST_F(HardestEdge, DisagreementWithoutAnEdge_AndATexelThatIsNotFinite_ArePassedOver) {
  for (int y = 0; y < 10; ++y)
    for (int x = 66; x < 78; ++x) *other_.at(x, y) = 0.0f;  // acne far from any edge
  *other_.at(2, 2) = std::numeric_limits<float>::quiet_NaN();
  *other_.at(20, 30) = 0.5f;
  EXPECT_TRUE(contains(find_disputed_edge({&reference_, &other_}, 0, {5, 5}), 20, 30));
}

TEST_F(HardestEdge, WithoutAnyEdge_HoldsTheDisagreement) {
  const Image lit = fill(Image(80, 40, 1), 1.0f);
  Image other = lit;
  *other.at(55, 20) = 0.0f;
  EXPECT_TRUE(contains(find_disputed_edge({&lit, &other}, 0, {5, 5}), 55, 20));
}

TEST_F(HardestEdge, FailedFilters_AreLeftOut) {
  *other_.at(20, 30) = 0.5f;
  const Image empty;
  EXPECT_TRUE(contains(find_disputed_edge({&empty, nullptr, &reference_, &other_}, 0, {5, 5}), 20, 30));
  EXPECT_EQ(find_disputed_edge({&empty}, 0, {5, 5}).width, 0);
}

TEST_F(HardestEdge, CropLargerThanTheImage_IsCutToIt) {
  const Rect crop = find_disputed_edge({&reference_}, 0, {500, 500});
  EXPECT_EQ(crop.width, 80);
  EXPECT_EQ(crop.height, 40);
}

TEST_F(HardestEdge, CropSize_FitsAnyPicture) {
  for (const Size picture : {Size{1, 1}, Size{64, 36}, Size{960, 540}, Size{2000, 3}, Size{3, 2000}}) {
    const Size crop = choose_crop_size(picture);
    EXPECT_GE(crop.width, 1);
    EXPECT_GE(crop.height, 1);
    EXPECT_LE(crop.width, picture.width);
    EXPECT_LE(crop.height, picture.height);
  }
}

std::string without_spaces(std::string text) {
  std::erase(text, ' ');
  return text;
}

Image draw(const std::string& text) {
  Image canvas(60, 40, 3);
  draw_text(canvas, 4, 4, text, {20, false}, {1.0f, 1.0f, 1.0f});
  return canvas;
}

TEST(Text, CleanText_HasNoControlCharactersAndIsUtf8) {
  EXPECT_EQ(clean_text("  a \n\t b\x01"
                       "c \x7f"),
            "a b c");
  EXPECT_EQ(clean_text("a\xff"
                       "b"),
            "a\xEF\xBF\xBD"
            "b");
  EXPECT_EQ(clean_text("Würfel · 2×"), "Würfel · 2×");
  EXPECT_EQ(clean_text(" "), "");
}

TEST(Text, CharactersOutsideAscii_AreDrawnAsThemselves) {
  EXPECT_NE(draw("·").texels, draw("7").texels);
  EXPECT_NE(draw("·").texels, draw("×").texels);
  EXPECT_NE(draw("ä").texels, draw("a").texels);
}

TEST(Text, WrappedLines_FitAndLoseNoCharacter) {
  const std::string text =
      "taps 16, radius 2.5 texels, rotation interleaved-gradient · "
      "a_word_so_long_that_it_must_be_broken_somewhere_ÄÖÜÄÖÜÄÖÜÄÖÜÄÖÜ end";
  for (const int width : {40, 100, 250, 900}) {
    std::string joined;
    for (const std::string& line : wrap_text(text, {20, false}, width)) {
      EXPECT_LE(measure_text(line, {20, false}), width) << line;
      EXPECT_EQ(clean_text(line), line);
      joined += line;
    }
    EXPECT_EQ(without_spaces(joined), without_spaces(text));
  }
}

TEST(Text, ShortText_IsOneLineAndEmptyTextNone) {
  EXPECT_THAT(wrap_text("vsm", {20, true}, 400), ElementsAre("vsm"));
  EXPECT_TRUE(wrap_text("", {20, true}, 400).empty());
}

TEST(Text, DrawnText_StaysInItsMeasuredBox) {
  const std::string text = "jÄg·Qy";
  const Font font{20, true};
  Image canvas(200, 60, 3);
  draw_text(canvas, 30, 10, text, font, {1.0f, 1.0f, 1.0f});
  bool any = false;
  for (int y = 0; y < canvas.height; ++y) {
    for (int x = 0; x < canvas.width; ++x) {
      if (*canvas.at(x, y) > 0.0f) {
        any = true;
        EXPECT_TRUE(x >= 30 && x < 30 + measure_text(text, font) && y >= 10 && y < 10 + line_height(font))
            << x << " " << y;
      }
    }
  }
  EXPECT_TRUE(any);
}

}  // namespace
}  // namespace shadowbench::images
