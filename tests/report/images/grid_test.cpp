#include "report/images/grid.h"

#include <cstdio>
#include <span>

#include "report/images/color_values.h"
#include "report/images/picture_io.h"
#include "report/images/sheet.h"
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

void expect_sound(const Grid& grid) { expect_sound(make_figure(grid)); }

// All texts of a layout, without spaces, so that wrapping does not matter.
std::string all_text(const Layout& layout) {
  std::string text;
  for (const PlacedText& line : layout.texts) text += line.text;
  std::erase(text, ' ');
  return text;
}

std::string all_text(const Grid& grid) { return all_text(layout_figure(make_figure(grid))); }

/// A grid's figure, laid out and drawn.
struct Drawn {
  Figure figure;
  Layout layout;
  Image canvas;

  explicit Drawn(const Grid& grid)
      : figure(make_figure(grid)), layout(layout_figure(figure)), canvas(draw_figure(figure)) {}

  /// Where the picture of a cell of a tile stands; its width is 0 where there is none.
  Rect find(std::size_t tile, GridCell cell) const { return find(figure.stacks.at(tile).at(cell)); }
  Rect find(const Cell& cell) const {
    for (const PlacedPicture& placed : layout.pictures)
      if (placed.picture == &cell.picture) return placed.box;
    return {};
  }

  /// How many tiles have a picture in a cell.
  std::size_t count(GridCell cell) const {
    std::size_t tiles = 0;
    for (std::size_t tile = 0; tile < figure.stacks.size(); ++tile) tiles += find(tile, cell).width > 0 ? 1 : 0;
    return tiles;
  }
};

Grid make_hard_grid() {
  Grid grid = make_grid(7, 96, 54);
  grid.title = "A scene whose title is so long that it must be wrapped, because someone named it so and meant it so";
  grid.tiles[1].caption =
      "taps 16, radius 2.5 texels, rotation interleaved-gradient, store rg32f, min_variance 1e-05 · 12.3 ms (CPU)";
  grid.tiles[2].label = "a_very_long_filter_name_without_any_space_in_it_that_a_user_chose";
  grid.tiles[4].picture = Image();
  grid.tiles[4].visibility = Image();
  grid.tiles[4].message = "timed out after 10 s";
  return grid;
}

TEST(Grid, AnyNumberOfFilters_NothingOverlapsAndNothingIsCut) {
  for (int tiles = 0; tiles <= 12; ++tiles) {
    SCOPED_TRACE(tiles);
    expect_sound(make_grid(tiles, 96, 54));
  }
}

TEST(Grid, AnySizeOfPicture_NothingOverlapsAndNothingIsCut) {
  for (const Size size : {Size{1, 1}, Size{64, 36}, Size{960, 540}, Size{300, 900}, Size{1500, 90}}) {
    SCOPED_TRACE(size.width);
    expect_sound(make_grid(4, size.width, size.height));
  }
}

TEST(Grid, LongTextsAndFailedTile_NothingOverlapsAndNothingIsCut) {
  expect_sound(make_hard_grid());
  Grid grid = make_hard_grid();
  grid.tiles[4].message = std::string(3000, 'x');
  expect_sound(grid);
  Grid failed;
  failed.tiles = {{"vsm", "radius 4", {}, {}, {}, "the filter crashed"}};
  expect_sound(failed);
}

TEST(Grid, OnlyErrors_NothingOverlapsAndThereIsNoMessage) {
  Grid grid = make_error_grid(5, 96, 54);
  for (GridTile& tile : grid.tiles) {
    tile.picture = Image();
    tile.visibility = Image();
  }
  grid.tiles[0].error = grid.tiles[1].error;
  expect_sound(grid);
  grid.tiles[2].message = "not shown";
  EXPECT_THAT(all_text(grid), Not(HasSubstr("notshown")));
  EXPECT_EQ(Drawn(grid).count(kErrorCell), 5u);
  EXPECT_THAT(all_text(grid), Not(HasSubstr("shadedpicture")));
}

TEST(Grid, EveryText_IsShownWhole) {
  const Grid grid = make_hard_grid();
  const std::string shown = all_text(grid);
  for (std::string text :
       {grid.title, grid.subtitle, grid.tiles[1].caption, grid.tiles[2].label, grid.tiles[4].message}) {
    std::erase(text, ' ');
    EXPECT_THAT(shown, HasSubstr(text));
  }
}

TEST(Grid, EveryFinishedFilter_HasItsPanels) {
  const Drawn drawn(make_hard_grid());
  for (const GridCell cell : {kPictureCell, kVisibilityCell, kCropCell}) {
    EXPECT_EQ(drawn.count(cell), 6u);
    EXPECT_EQ(drawn.find(4, cell).width, 0);
  }
}

TEST(Grid, MagnifiedCrop_ShowsWholeTexelsOfThatCrop) {
  const Grid grid = make_grid(2, 96, 54);
  const Drawn drawn(grid);
  for (std::size_t tile = 0; tile < 2; ++tile) {
    const Rect box = drawn.find(tile, kCropCell);
    const int factor = box.width / 2 / grid.crop.width;
    const int outline = (box.height - factor * grid.crop.height) / 2;
    ASSERT_GT(factor, 1);
    ASSERT_EQ(outline, 2);
    const int left = box.x + box.width - outline - factor * grid.crop.width, top = box.y + outline;
    for (int y = 0; y < factor * grid.crop.height; ++y) {
      for (int x = 0; x < factor * grid.crop.width; ++x) {
        ASSERT_EQ(*drawn.canvas.at(left + x, top + y),
                  *grid.tiles[tile].visibility.at(grid.crop.x + x / factor, grid.crop.y + y / factor));
      }
    }
    EXPECT_NE(drawn.canvas.at(left - 1, top)[0], drawn.canvas.at(left - 1, top)[2]) << "the outline";
  }
}

TEST(Grid, Exposure_ScalesThePictureInLinearLightAndNotTheVisibility) {
  Grid grid = make_grid(1, 64, 36);
  grid.exposure = 0.5;
  const Drawn drawn(grid);
  const Rect picture = drawn.find(0, kPictureCell), visibility = drawn.find(0, kVisibilityCell);
  const int right = picture.width - 1;
  EXPECT_EQ(*drawn.canvas.at(picture.x + right, picture.y), encode_srgb(0.5f * *grid.tiles[0].picture.at(63, 0)));
  EXPECT_EQ(*drawn.canvas.at(visibility.x + right, visibility.y), 1.0f);
}

TEST(Grid, ReducedPicture_KeepsLightAndAddsNoRinging) {
  Grid grid = make_grid(1, 960, 540);
  grid.crop = {};
  grid.tiles[0].picture = Image(960, 540, 3);
  for (int y = 0; y < 540; ++y)
    for (int x = 0; x < 960; ++x) std::fill_n(grid.tiles[0].picture.at(x, y), 3, x < 480 ? 0.2f : 0.6f);
  const Drawn drawn(grid);
  const Rect box = drawn.find(0, kPictureCell);
  for (int x = 0; x < box.width; ++x) {
    const float value = *drawn.canvas.at(box.x + x, box.y + 100);
    EXPECT_GE(value, encode_srgb(0.2f) - 1e-5f);
    EXPECT_LE(value, encode_srgb(0.6f) + 1e-5f);
  }
  EXPECT_NEAR(*drawn.canvas.at(box.x + 10, box.y + 100), encode_srgb(0.2f), 1e-5f);
  EXPECT_NEAR(*drawn.canvas.at(box.x + box.width - 10, box.y + 100), encode_srgb(0.6f), 1e-5f);
}

TEST(Grid, TexelThatIsNotFinite_IsMagenta) {
  Grid grid = make_grid(1, 64, 36);
  grid.crop = {};
  *grid.tiles[0].visibility.at(0, 0) = std::numeric_limits<float>::quiet_NaN();
  *grid.tiles[0].picture.at(1, 1) = std::numeric_limits<float>::infinity();
  grid.tiles[0].error = make_visibility(64, 36, 9.0f);
  *grid.tiles[0].error.at(0, 0) = -std::numeric_limits<float>::infinity();
  const Drawn drawn(grid);
  for (const auto& [cell, texel] : {std::pair{kVisibilityCell, 0}, {kPictureCell, 1}, {kErrorCell, 0}}) {
    const Rect box = drawn.find(0, cell);
    const int factor = box.width / 64;
    const float* shown = drawn.canvas.at(box.x + factor * texel, box.y + factor * texel);
    EXPECT_TRUE(std::equal(shown, shown + 3, kMagenta.begin())) << cell;
  }
}

// The drawn picture, not the plan: ink outside the boxes would be text cut off or overlapping.
TEST(Grid, OutsideTheBoxes_TheCanvasIsEmpty) {
  for (const Grid& grid : {make_hard_grid(), make_error_grid(7, 96, 54)}) {
    Image canvas = draw_figure(make_figure(grid));
    const Figure figure = make_figure(grid);
    for (const Rect& box : list_boxes(layout_figure(figure)))
      for (int y = box.y; y < box.y + box.height; ++y) std::fill_n(canvas.at(box.x, y), box.width * 3, 1.0f);
    const auto ink =
        std::find_if(canvas.texels.begin(), canvas.texels.end(), [](float value) { return value != 1.0f; });
    const auto texel = static_cast<int>(ink - canvas.texels.begin()) / canvas.channels;
    EXPECT_TRUE(ink == canvas.texels.end()) << "ink at " << texel % canvas.width << ", " << texel / canvas.width;
  }
}

TEST(Grid, TilesWithErrors_GetAHeatMapAndOneColourBar) {
  Grid grid;
  grid.title = "t";
  grid.tiles = {make_tile("truth", 96, 54, 0.5f), make_tile("a", 96, 54, 0.4f)};
  const Drawn without(grid);
  ASSERT_EQ(without.figure.legend.size(), 1u) << "the rows' explanation alone";
  EXPECT_TRUE(without.figure.legend[0].picture.empty());
  grid.tiles[1].error = Image(96, 54, 1);
  grid.tiles[1].error.texels[40] = -0.3f;
  const Drawn drawn(grid);
  ASSERT_EQ(drawn.figure.legend.size(), 2u);
  EXPECT_THAT(list_each(drawn.layout.texts, &PlacedText::text), AllOf(Contains("-0.5"), Contains("0.5")));
  EXPECT_EQ(drawn.count(kErrorCell), 1u);
  EXPECT_GT(drawn.layout.canvas.height, without.layout.canvas.height);
  const Rect bar = drawn.find(drawn.figure.legend[0]);
  ASSERT_GT(bar.width, 0);
  const float* left = drawn.canvas.at(bar.x + 2, bar.y + 2);
  const float* right = drawn.canvas.at(bar.x + bar.width - 3, bar.y + 2);
  EXPECT_GT(left[2], left[0] + 0.3f);
  EXPECT_GT(right[0], right[2] + 0.3f);
}

TEST(Figure, TicksThatHaveNoRoom_LoseTheirLabelsAndNoneOverlap) {
  Cell cell{"", "", Image(200, 100, 3)};
  for (int i = 0; i <= 40; ++i) {
    cell.below.push_back({i / 40.0, "a long label " + std::to_string(i)});
    cell.beside.push_back({i / 40.0, std::to_string(1000 * i)});
  }
  const Figure figure{"title", "note", {{cell, cell}, {}, {cell}}, 2, {cell}};
  expect_sound(figure);
  const Layout layout = layout_figure(figure);
  EXPECT_EQ(layout.marks.size(), 4u * 82u);
  EXPECT_EQ(std::ranges::count(layout.texts, "a long label 0", &PlacedText::text), 4);
  EXPECT_EQ(std::ranges::count(layout.texts, "0", &PlacedText::text), 4);
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
  const Figure figure = make_figure(make_error_grid(7, 96, 54));
  const Layout layout = layout_figure(figure);
  const Image whole = draw_figure(figure);
  for (int top = 0; top < layout.canvas.height; top += 100) {
    const Image band = draw_rows(layout, top, std::min(100, layout.canvas.height - top));
    ASSERT_TRUE(std::ranges::equal(band.texels, std::span(whole.at(0, top), band.texels.size()))) << top;
  }
}

TEST(Grid, VisibilityWithoutReceiver_IsHatchedAndNotBlack) {
  Grid grid = make_grid(1, 64, 36);
  grid.crop = {};
  grid.tiles[0].visibility = Image(64, 36, 1);
  grid.mask = fill(Image(64, 36, 1), 1.0f);
  for (int y = 0; y < 36; ++y) std::fill_n(grid.mask.at(0, y), 32, 0.0f);
  const Drawn drawn(grid);
  const Rect box = drawn.find(0, kVisibilityCell);
  EXPECT_GT(*drawn.canvas.at(box.x + 4, box.y + 4), 0.4f);
  EXPECT_EQ(*drawn.canvas.at(box.x + box.width - 4, box.y + 4), 0.0f);
}

}  // namespace
}  // namespace shadowbench::images
