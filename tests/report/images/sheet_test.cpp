#include "report/images/sheet.h"

#include <cstdio>
#include <span>

#include "report/images/color_values.h"
#include "report/images/crop.h"
#include "report/images/heat_figures.h"
#include "report/images/picture_io.h"
#include "tests/report/records/synthetic.h"

namespace shadowbench::images {

using namespace records;
namespace {

bool overlaps(const Rect& a, const Rect& b) {
  return a.x < b.x + b.width && b.x < a.x + a.width && a.y < b.y + b.height && b.y < a.y + a.height;
}

bool contains(const Rect& outer, const Rect& inner) {
  return inner.x >= outer.x && inner.y >= outer.y && inner.x + inner.width <= outer.x + outer.width &&
         inner.y + inner.height <= outer.y + outer.height;
}

Rect grow(const Rect& r, int by) { return {r.x - by, r.y - by, r.width + 2 * by, r.height + 2 * by}; }

std::vector<Rect> list_boxes(const Layout& layout) {
  std::vector<Rect> boxes;
  for (const PlacedRect& mark : layout.marks) boxes.push_back(mark.box);
  for (const PlacedPicture& placed : layout.pictures) boxes.push_back(grow(placed.box, 1));
  for (const PlacedText& text : layout.texts) boxes.push_back(text.box);
  return boxes;
}

/// No box leaves the canvas or lies over another, and each text fits into its own.
void expect_sound(const Layout& layout, const std::vector<Rect>& boxes) {
  const Rect canvas{0, 0, layout.canvas.width, layout.canvas.height};
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    EXPECT_TRUE(contains(canvas, boxes[i])) << i;
    for (std::size_t j = 0; j < i; ++j) EXPECT_FALSE(overlaps(boxes[i], boxes[j])) << i << " " << j;
  }
  for (const PlacedText& text : layout.texts)
    EXPECT_LE(measure_text(text.text, text.font), text.box.width) << text.text;
}

void expect_sound(const Figure& figure) {
  const Layout layout = layout_figure(figure);
  expect_sound(layout, list_boxes(layout));
}

// All texts of a layout, without spaces, so that wrapping does not matter.
std::string all_text(const Layout& layout) {
  std::string text;
  for (const PlacedText& line : layout.texts) text += line.text;
  std::erase(text, ' ');
  return text;
}

/// A figure of visibility over its errors, with texts of every length and a stack that has none of both.
Figure make_hard_figure(int tiles, int width, int height) {
  std::vector<ErrorTile> shown;
  for (int i = 0; i < tiles; ++i) {
    ErrorTile& tile = shown.emplace_back(ErrorTile{"vsm", "radius 4, rg32f · 12.3 ms (CPU)",
                                                   make_visibility(width, height, 0.01f + 4.0f * static_cast<float>(i)),
                                                   make_visibility(width, height, 9.0f)});
    for (float& value : tile.error.texels) value = 0.3f * (value - 0.5f);
  }
  if (tiles > 1) shown[1].title = "a_very_long_filter_name_without_any_space_in_it_that_a_user_chose";
  if (tiles > 2)
    shown[2].words =
        "taps 16, radius 2.5 texels, rotation interleaved-gradient, store rg32f, min_variance 1e-05 · 12.3 ms (CPU)";
  Figure figure = show_errors(
      "A scene whose title is so long that it must be wrapped, because someone named it so and meant it so", shown);
  figure.stacks.push_back({{.title = "pcss", .warning = std::string(3000, 'x')}});
  return figure;
}

TEST(Figure, AnyNumberAndSizeOfPicturesAndTexts_NothingOverlapsAndNothingIsCut) {
  for (int tiles = 0; tiles <= 12; ++tiles) expect_sound(make_hard_figure(tiles, 96, 54));
  for (const Size size : {Size{1, 1}, Size{64, 36}, Size{960, 540}, Size{300, 900}, Size{1500, 90}}) {
    SCOPED_TRACE(size.width);
    expect_sound(make_hard_figure(4, size.width, size.height));
  }
}

TEST(Figure, EveryText_IsShownWhole) {
  const Figure figure = make_hard_figure(3, 96, 54);
  const std::string shown = all_text(layout_figure(figure));
  for (std::string text :
       {figure.title, figure.stacks[1][0].title, figure.stacks[2][0].words, figure.stacks[3][0].warning}) {
    std::erase(text, ' ');
    EXPECT_THAT(shown, HasSubstr(text));
  }
}

// The drawn picture, not the plan: ink outside the boxes would be text cut off or overlapping.
TEST(Figure, OutsideTheBoxes_TheCanvasIsEmpty) {
  const Figure figure = make_hard_figure(7, 96, 54);
  Image canvas = draw_figure(figure);
  for (const Rect& box : list_boxes(layout_figure(figure)))
    for (int y = box.y; y < box.y + box.height; ++y) std::fill_n(canvas.at(box.x, y), box.width * 3, 1.0f);
  const auto ink = std::ranges::find_if(canvas.texels, [](float value) { return value != 1.0f; });
  const auto texel = static_cast<int>(ink - canvas.texels.begin()) / canvas.channels;
  EXPECT_TRUE(ink == canvas.texels.end()) << "ink at " << texel % canvas.width << ", " << texel / canvas.width;
}

TEST(ShownErrors, ShareOneScale_WhichTheBarBelowHas) {
  const Image visibility(96, 54, 1);
  Image error(96, 54, 1);
  error.texels[40] = -0.3f;
  const Figure figure = show_errors("t", {{"a", "", visibility, error}, {"b", "", visibility, Image(96, 54, 1)}});
  EXPECT_THAT(list_each(figure.legend.at(0).below, &Tick::label), AllOf(Contains("-0.5"), Contains("0.5")));
  const Image& bar = figure.legend[0].picture;
  EXPECT_GT(bar.at(2, 2)[2], bar.at(2, 2)[0] + 0.3f);
  EXPECT_GT(bar.at(bar.width - 3, 2)[0], bar.at(bar.width - 3, 2)[2] + 0.3f);
}

TEST(ShownPart, IsOutlined_AndMagnifiedByWholeTexels) {
  const Image visibility = make_visibility(96, 54, 4.0f);
  const Size size = choose_crop_size({96, 54});
  const Rect part{30, 20, size.width, size.height};
  const Stack stack = show_part({"a", "words"}, visibility, part, distance_from_lit, map_grey);
  ASSERT_EQ(stack.size(), 2u);
  EXPECT_EQ(stack[0].words, "words");
  const Image& shown = stack[1].picture;
  const int factor = shown.width / part.width;
  ASSERT_GT(factor, 1);
  ASSERT_EQ(shown.width, factor * part.width + 2);
  for (int y = 0; y < factor * part.height; ++y)
    for (int x = 0; x < factor * part.width; ++x)
      ASSERT_EQ(*shown.at(x + 1, y + 1), *visibility.at(part.x + x / factor, part.y + y / factor));
  EXPECT_NE(shown.at(0, 0)[0], shown.at(0, 0)[2]) << "the outline";
}

TEST(ShownPicture, IsScaledInLinearLight) {
  const Image picture = fill(Image(64, 36, 3), 0.4f);
  EXPECT_EQ(*show_picture(picture, 0.5).at(0, 0), encode_srgb(0.2f));
}

TEST(ShownPicture, Reduced_KeepsLightAndAddsNoRinging) {
  Image picture(960, 540, 3);
  for (int y = 0; y < 540; ++y)
    for (int x = 0; x < 960; ++x) std::fill_n(picture.at(x, y), 3, x < 480 ? 0.2f : 0.6f);
  const Image shown = show_picture(picture);
  ASSERT_LT(shown.width, 960);
  for (int x = 0; x < shown.width; ++x) {
    EXPECT_GE(*shown.at(x, 100), encode_srgb(0.2f) - 1e-5f);
    EXPECT_LE(*shown.at(x, 100), encode_srgb(0.6f) + 1e-5f);
  }
  EXPECT_NEAR(*shown.at(10, 100), encode_srgb(0.2f), 1e-5f);
  EXPECT_NEAR(*shown.at(shown.width - 10, 100), encode_srgb(0.6f), 1e-5f);
}

TEST(ShownPicture, TexelThatIsNotFinite_IsMagenta) {
  Image picture(64, 36, 3), visibility(64, 36, 1);
  *picture.at(0, 0) = std::numeric_limits<float>::infinity();
  *visibility.at(0, 0) = std::numeric_limits<float>::quiet_NaN();
  for (const Image& shown : {show_picture(picture), show_visibility(visibility)})
    EXPECT_TRUE(std::equal(shown.at(0, 0), shown.at(0, 0) + 3, kMagenta.begin()));
}

TEST(Figure, TicksThatHaveNoRoom_LoseTheirLabelsAndNoneOverlap) {
  Cell cell{"", "", Image(200, 100, 3)};
  for (int i = 0; i <= 40; ++i) cell.below.push_back({i / 40.0, "a long label " + std::to_string(i)});
  const Figure figure{"title", "note", {{cell, cell}, {}, {cell}}, 2, {cell}};
  expect_sound(figure);
  const Layout layout = layout_figure(figure);
  EXPECT_EQ(layout.marks.size(), 4u * 41u);
  EXPECT_EQ(std::ranges::count(layout.texts, "a long label 0", &PlacedText::text), 4);
}

Sheet make_sheet(std::size_t filters, const std::string& name = "pcf2x2") {
  Sheet sheet{"fence: which filter is nearest to the truth?",
              "Sorted by error. Map 1024², image 960 × 540.",
              {"ray-traced truth", "", {}, "the reference", "", "", Image(kSheetCrop.width, kSheetCrop.height, 3), {}},
              {},
              Image(960, 540, 3),
              {400, 200, kSheetCrop.width, kSheetCrop.height},
              {"Number: RMSE of visibility; bars have one scale.", "Cost of a frame: estimate for navi21."}};
  const Image crop(kSheetCrop.width, kSheetCrop.height, 3);
  for (std::size_t i = 0; i < filters; ++i)
    sheet.filters.push_back({name, "0.043", static_cast<double>(i + 1) / static_cast<double>(filters), "≈ 28.9 µs",
                             "balanced", "", crop, crop});
  return sheet;
}

/// Images may overlap, and a bar lies on its background; no text overlaps anything.
void expect_legible(const Sheet& sheet, SheetWidth width = {}) {
  const Layout layout = layout_sheet(sheet, width);
  expect_sound(layout, list_each(layout.texts, &PlacedText::box));
  for (const PlacedText& text : layout.texts) {
    for (const PlacedPicture& placed : layout.pictures) EXPECT_FALSE(overlaps(text.box, placed.box)) << text.text;
    for (const PlacedRect& mark : layout.marks) EXPECT_FALSE(overlaps(text.box, mark.box)) << text.text;
  }
  for (const PlacedPicture& placed : layout.pictures)
    EXPECT_TRUE(contains({0, 0, layout.canvas.width, layout.canvas.height}, placed.box));
}

const std::vector<SheetWidth> kSheetWidths = {{480.0}, {960.0}, {1920.0}, {3.3, true}, {7.0, true}};

TEST(Sheet, AnyNumberOfFiltersAndWidth_IsLegible) {
  for (const SheetWidth width : kSheetWidths)
    for (std::size_t filters = 0; filters <= kFiltersOfSheet; ++filters) {
      SCOPED_TRACE(std::to_string(width.value) + ", " + std::to_string(filters));
      expect_legible(make_sheet(filters), width);
    }
}

TEST(Sheet, LongNames_AreShownWholeUpToSixtyLetters) {
  for (const std::string& name :
       {std::string(60, 'w'), std::string("a name of words that are short but many, in all 60 of them")}) {
    Sheet sheet = make_sheet(kFiltersOfSheet, name);
    for (const SheetWidth width : kSheetWidths) expect_legible(sheet, width);
    sheet.filters.resize(1);
    std::string wanted = name;
    std::erase(wanted, ' ');
    EXPECT_THAT(all_text(layout_sheet(sheet)), HasSubstr(wanted));
  }
}

TEST(Sheet, WithoutTruthCostViewOrImages_SaysWhatThereIs) {
  Sheet sheet = make_sheet(2);
  sheet.truth = {.name = "no truth", .message = "the run was made with --no-truth"};
  sheet.filters[0] = {.name = "pcss", .message = std::string(400, 'x')};
  sheet.filters[1].words.clear();
  sheet.view = Image();
  expect_legible(sheet);
  EXPECT_THAT(list_each(layout_sheet(sheet).texts, &PlacedText::text),
              AllOf(Contains(HasSubstr("--no-truth")), Contains(HasSubstr("…")), Contains("balanced")));
}

TEST(Sheet, Full_IsAtMostASlide) {
  for (std::size_t filters = 1; filters <= kFiltersOfSheet; ++filters) {
    const Size canvas = layout_sheet(make_sheet(filters)).canvas;
    EXPECT_LE(canvas.width, 1920);
    EXPECT_LE(canvas.height, 1080);
    EXPECT_GT(canvas.width, canvas.height);
  }
  EXPECT_GT(layout_sheet(make_sheet(kFiltersOfSheet)).canvas.width, 1800);
}

TEST(Sheet, Bars_HaveOneScale) {
  const Sheet sheet = make_sheet(4);
  std::vector<int> lengths;
  const Layout layout = layout_sheet(sheet);
  for (std::size_t i = 1; i < layout.marks.size(); ++i)
    if (layout.marks[i].box.y == layout.marks[i - 1].box.y && layout.marks[i].box.x == layout.marks[i - 1].box.x)
      lengths.push_back(layout.marks[i].box.width);
  ASSERT_GE(lengths.size(), 4u);
  for (std::size_t i = 0; i < 4; ++i)
    EXPECT_NEAR(lengths[i], static_cast<double>(lengths[3]) * static_cast<double>(i + 1) / 4.0, 1.0);
}

TEST(Sheet, Crops_AreMagnifiedToWholeTexelsOfAScreen) {
  const Sheet sheet = make_sheet(kFiltersOfSheet);
  for (const PlacedPicture& placed : layout_sheet(sheet).pictures)
    if (placed.picture != &sheet.view) EXPECT_EQ(placed.box.width % placed.picture->width, 0);
  const Layout layout = layout_sheet(sheet);
  EXPECT_EQ(layout.pictures.front().box.width, 4 * kSheetCrop.width);
}

TEST(Sheet, InInches_IsAnSvgWithTextOfEightPoints) {
  const TestFolder folder;
  Sheet sheet = make_sheet(3, "a<b&c");
  write_sheet(folder.path() / "a.svg", sheet, {3.3, true});
  const std::string svg = read_text(folder.path() / "a.svg");
  EXPECT_THAT(svg, HasSubstr("a&lt;b&amp;c"));
  EXPECT_THAT(svg, HasSubstr("data:image/png;base64,iVBORw0KGgo"));
  double inches = 0.0;
  ASSERT_EQ(std::sscanf(svg.c_str() + svg.find("width=\""), "width=\"%lfin", &inches), 1);
  EXPECT_NEAR(inches, 3.3, 0.02);
  const Layout layout = layout_sheet(sheet, {3.3, true});
  const auto words = std::ranges::find(layout.texts, "the reference", &PlacedText::text);
  ASSERT_NE(words, layout.texts.end());
  EXPECT_NEAR(words->font.size * 72.0 * inches / layout.canvas.width, 8.0, 0.05);
}

TEST(Figure, DrawnInBands_IsTheSamePicture) {
  const Figure figure = make_hard_figure(7, 96, 54);
  const Layout layout = layout_figure(figure);
  const Image whole = draw_figure(figure);
  for (int top = 0; top < layout.canvas.height; top += 100) {
    const Image band = draw_rows(layout, top, std::min(100, layout.canvas.height - top));
    ASSERT_TRUE(std::ranges::equal(band.texels, std::span(whole.at(0, top), band.texels.size()))) << top;
  }
}

}  // namespace
}  // namespace shadowbench::images
