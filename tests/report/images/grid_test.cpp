#include "report/images/grid.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "report/images/grid_layout.h"
#include "report/images/picture_io.h"
#include "tests/report/records/synthetic.h"

namespace shadowbench::images {

using namespace records;
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

constexpr int kFrameWidth = 2;

bool overlaps(const Rect& a, const Rect& b) {
  return a.x < b.x + b.width && b.x < a.x + a.width && a.y < b.y + b.height && b.y < a.y + a.height;
}

bool contains(const Rect& outer, const Rect& inner) {
  return inner.x >= outer.x && inner.y >= outer.y && inner.x + inner.width <= outer.x + outer.width &&
         inner.y + inner.height <= outer.y + outer.height;
}

Rect grow(const Rect& r, int by) { return {r.x - by, r.y - by, r.width + 2 * by, r.height + 2 * by}; }

std::vector<Rect> list_boxes(const GridLayout& layout) {
  std::vector<Rect> boxes;
  for (const Panel& panel : layout.panels) boxes.push_back(grow(panel.box, kFrameWidth));
  for (const TextLine& line : layout.texts)
    if (line.role != TextRole::kMessage) boxes.push_back(line.box);
  boxes.insert(boxes.end(), layout.message_boxes.begin(), layout.message_boxes.end());
  for (const BarPlace& bar : layout.bars) boxes.push_back(bar.box);
  for (const Swatch& swatch : layout.swatches) boxes.push_back(swatch.box);
  if (layout.color_bar) boxes.push_back(grow(*layout.color_bar, 1));
  return boxes;
}

bool lies_in_any(const Rect& inner, const std::vector<Rect>& boxes) {
  return std::any_of(
      boxes.begin(), boxes.end(), [&](const Rect& outer) { return contains(outer, inner); });
}

void expect_sound(const Grid& grid) {
  const GridLayout layout = layout_grid(grid);
  const Rect canvas{0, 0, layout.canvas.width, layout.canvas.height};
  const std::vector<Rect> boxes = list_boxes(layout);
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    EXPECT_TRUE(contains(canvas, boxes[i])) << i;
    for (std::size_t j = 0; j < i; ++j) EXPECT_FALSE(overlaps(boxes[i], boxes[j])) << i << " " << j;
  }
  for (const TextLine& line : layout.texts) {
    EXPECT_LE(measure_text(line.text, font_of(line.role)), line.box.width) << line.text;
    EXPECT_TRUE(line.role != TextRole::kMessage || lies_in_any(line.box, layout.message_boxes)) << line.text;
  }
}

// Everything a grid says, spaces left out, so that wrapping does not matter.
std::string all_text(const Grid& grid) {
  std::string text;
  for (const TextLine& line : layout_grid(grid).texts) text += line.text;
  text.erase(std::remove(text.begin(), text.end(), ' '), text.end());
  return text;
}

std::vector<Panel> panels_of(const Grid& grid, PanelKind kind) {
  std::vector<Panel> panels;
  for (const Panel& panel : layout_grid(grid).panels)
    if (panel.kind == kind) panels.push_back(panel);
  return panels;
}

Grid make_hard_attributed_grid() {
  Grid grid = make_attributed_grid(7, 96, 54);
  grid.tiles[5].no_attribution = std::string(300, 'x') + " and more";
  grid.tiles[4] = {"mine", "radius 4", {}, {}, {}, "timed out after 10 s"};
  grid.tiles[2].attribution = AttributionBar{{0.5, -0.25, -0.25, 0.5}};
  return grid;
}

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

TEST(Grid, AnyNumberOfBars_NothingOverlapsAndNothingIsCut) {
  for (int tiles = 1; tiles <= 9; ++tiles) {
    SCOPED_TRACE(tiles);
    expect_sound(make_attributed_grid(tiles, 96, 54));
  }
}

TEST(Grid, BarsBesideFailedTilesAndLongReasons_NothingOverlapsAndNothingIsCut) {
  Grid grid = make_hard_attributed_grid();
  expect_sound(grid);
  for (const int columns : {1, 2, 4}) {
    grid.columns = columns;
    expect_sound(grid);
  }
}

TEST(Grid, OnlyErrors_NothingOverlapsAndThereIsNoMessage) {
  Grid grid = make_attributed_grid(5, 96, 54);
  for (GridTile& tile : grid.tiles) {
    tile.picture = Image();
    tile.visibility = Image();
  }
  grid.tiles[0].error = grid.tiles[1].error;
  expect_sound(grid);
  EXPECT_TRUE(layout_grid(grid).message_boxes.empty());
  EXPECT_EQ(panels_of(grid, PanelKind::kError).size(), 5u);
  EXPECT_THAT(all_text(grid), Not(HasSubstr("shadedpicture")));
}

TEST(Grid, EveryText_IsShownWhole) {
  const Grid grid = make_hard_grid();
  const std::string shown = all_text(grid);
  for (std::string text :
       {grid.title, grid.subtitle, grid.tiles[1].caption, grid.tiles[2].label, grid.tiles[4].message}) {
    text.erase(std::remove(text.begin(), text.end(), ' '), text.end());
    EXPECT_THAT(shown, ::testing::HasSubstr(text));
  }
}

TEST(Grid, EveryFinishedFilter_HasItsFourPanels) {
  const Grid grid = make_hard_grid();
  for (const PanelKind kind :
       {PanelKind::kPicture, PanelKind::kVisibility, PanelKind::kPictureCrop, PanelKind::kVisibilityCrop}) {
    std::vector<std::size_t> tiles;
    for (const Panel& panel : panels_of(grid, kind)) tiles.push_back(panel.tile);
    EXPECT_THAT(tiles, ::testing::ElementsAre(0, 1, 2, 3, 5, 6));
  }
  EXPECT_EQ(layout_grid(grid).message_boxes.size(), 1u);
}

TEST(Grid, DefaultRun_IsAbout1500PixelsWideInThreeColumns) {
  const Grid grid = make_grid(6, 960, 540);
  EXPECT_NEAR(layout_grid(grid).canvas.width, 1500, 20);
  const auto pictures = panels_of(grid, PanelKind::kPicture);
  EXPECT_EQ(pictures[0].box.y, pictures[2].box.y);
  EXPECT_LT(pictures[2].box.y, pictures[3].box.y);
  EXPECT_EQ(pictures[0].box.x, pictures[3].box.x);
}

TEST(Grid, MagnifiedCrop_ShowsWholeTexelsOfThatCrop) {
  const Grid grid = make_grid(2, 96, 54);
  const Image canvas = draw_grid(grid);
  for (const Panel& panel : panels_of(grid, PanelKind::kVisibilityCrop)) {
    const int factor = panel.box.width / grid.crop.width;
    ASSERT_EQ(panel.box.width, factor * grid.crop.width);
    ASSERT_EQ(panel.box.height, factor * grid.crop.height);
    for (int y = 0; y < panel.box.height; ++y) {
      for (int x = 0; x < panel.box.width; ++x) {
        ASSERT_EQ(*canvas.at(panel.box.x + x, panel.box.y + y),
                  *grid.tiles[panel.tile].visibility.at(grid.crop.x + x / factor, grid.crop.y + y / factor));
      }
    }
  }
}

TEST(Grid, EqualTiles_LookEqual) {
  Grid grid = make_grid(2, 960, 540);
  grid.tiles[1].picture = grid.tiles[0].picture;
  grid.exposure = 1.5;
  const Image canvas = draw_grid(grid);
  const auto panels = panels_of(grid, PanelKind::kPicture);
  for (int y = 0; y < panels[0].box.height; ++y) {
    const float* a = canvas.at(panels[0].box.x, panels[0].box.y + y);
    const float* b = canvas.at(panels[1].box.x, panels[1].box.y + y);
    ASSERT_TRUE(std::equal(a, a + panels[0].box.width * 3, b)) << y;
  }
}

TEST(Grid, Exposure_ScalesThePictureInLinearLightAndNotTheVisibility) {
  Grid grid = make_grid(1, 64, 36);
  grid.exposure = 0.5;
  const Image canvas = draw_grid(grid);
  const Panel picture = panels_of(grid, PanelKind::kPicture).at(0);
  const Panel visibility = panels_of(grid, PanelKind::kVisibility).at(0);
  const int right = picture.box.width - 1;
  EXPECT_EQ(*canvas.at(picture.box.x + right, picture.box.y), encode_srgb(0.5f * *grid.tiles[0].picture.at(63, 0)));
  EXPECT_EQ(*canvas.at(visibility.box.x + right, visibility.box.y), 1.0f);
}

TEST(Grid, ReducedPicture_KeepsLightAndAddsNoRinging) {
  Grid grid = make_grid(1, 960, 540);
  grid.crop = {};
  grid.tiles[0].picture = Image(960, 540, 3);
  for (int y = 0; y < 540; ++y)
    for (int x = 0; x < 960; ++x) std::fill_n(grid.tiles[0].picture.at(x, y), 3, x < 480 ? 0.2f : 0.6f);
  const Image canvas = draw_grid(grid);
  const Panel panel = panels_of(grid, PanelKind::kPicture).at(0);
  for (int x = 0; x < panel.box.width; ++x) {
    const float value = *canvas.at(panel.box.x + x, panel.box.y + 100);
    EXPECT_GE(value, encode_srgb(0.2f) - 1e-5f);
    EXPECT_LE(value, encode_srgb(0.6f) + 1e-5f);
  }
  EXPECT_NEAR(*canvas.at(panel.box.x + 10, panel.box.y + 100), encode_srgb(0.2f), 1e-5f);
  EXPECT_NEAR(*canvas.at(panel.box.x + panel.box.width - 10, panel.box.y + 100), encode_srgb(0.6f), 1e-5f);
}

TEST(Grid, TexelThatIsNotFinite_IsMagenta) {
  Grid grid = make_grid(1, 64, 36);
  grid.crop = {};
  *grid.tiles[0].visibility.at(0, 0) = std::numeric_limits<float>::quiet_NaN();
  const Panel panel = panels_of(grid, PanelKind::kVisibility).at(0);
  const Image canvas = draw_grid(grid);
  EXPECT_EQ(canvas.at(panel.box.x, panel.box.y)[0], 1.0f);
  EXPECT_EQ(canvas.at(panel.box.x, panel.box.y)[1], 0.0f);
}

// The drawn picture, not the plan: ink outside the boxes would be text cut off or overlapping.
TEST(Grid, OutsideTheBoxes_TheCanvasIsEmpty) {
  for (const Grid& grid : {make_hard_grid(), make_hard_attributed_grid()}) {
    Image canvas = draw_grid(grid);
    for (const Rect& box : list_boxes(layout_grid(grid)))
      for (int y = box.y; y < box.y + box.height; ++y) std::fill_n(canvas.at(box.x, y), box.width * 3, 1.0f);
    const auto ink =
        std::find_if(canvas.texels.begin(), canvas.texels.end(), [](float value) { return value != 1.0f; });
    const auto texel = static_cast<int>(ink - canvas.texels.begin()) / canvas.channels;
    EXPECT_TRUE(ink == canvas.texels.end()) << "ink at " << texel % canvas.width << ", " << texel / canvas.width;
  }
}

TEST(Grid, CropIsOutlinedOnThePicture) {
  const Grid grid = make_grid(1, 468, 260);
  const Image canvas = draw_grid(grid);
  const Panel panel = panels_of(grid, PanelKind::kVisibility).at(0);
  ASSERT_EQ(panel.box.width, 468);
  const float* left = canvas.at(panel.box.x + grid.crop.x - 1, panel.box.y + grid.crop.y + 5);
  const float* inside = canvas.at(panel.box.x + grid.crop.x, panel.box.y + grid.crop.y + 5);
  EXPECT_NE(left[0], left[2]);
  EXPECT_EQ(inside[0], *grid.tiles[0].visibility.at(grid.crop.x, grid.crop.y + 5));
}

TEST(Grid, File_HoldsTheDrawnPicture) {
  const TemporaryFolder folder("grid_file");
  const Grid grid = make_grid(2, 64, 36);
  write_grid(folder.path() / "cubes.grid.png", grid);
  const Image back = read_picture(folder.path() / "cubes.grid.png");
  const Image drawn = draw_grid(grid);
  ASSERT_EQ(back.width, drawn.width);
  ASSERT_EQ(back.height, drawn.height);
  for (std::size_t i = 0; i < drawn.texels.size(); ++i) ASSERT_NEAR(back.texels[i], drawn.texels[i], 0.51f / 255.0f);
}

TEST(Grid, TilesWithErrors_GetAHeatMapAndOneColourBar) {
  Grid grid;
  grid.title = "t";
  grid.tiles = {make_tile("truth", 96, 54, 0.5f), make_tile("a", 96, 54, 0.4f)};
  const GridLayout without = layout_grid(grid);
  EXPECT_FALSE(without.color_bar);
  grid.tiles[1].error = Image(96, 54, 1);
  grid.tiles[1].error.texels[40] = -0.3f;
  const GridLayout layout = layout_grid(grid);
  ASSERT_TRUE(layout.color_bar);
  EXPECT_DOUBLE_EQ(layout.error_scale, 0.5);
  EXPECT_EQ(std::count_if(layout.panels.begin(), layout.panels.end(),
                          [](const Panel& p) { return p.kind == PanelKind::kError; }),
            1);
  EXPECT_GT(layout.canvas.height, without.canvas.height);
  const Image drawn = draw_grid(grid);
  const Rect bar = *layout.color_bar;
  const float* left = drawn.at(bar.x + 2, bar.y + 2);
  const float* right = drawn.at(bar.x + bar.width - 3, bar.y + 2);
  EXPECT_GT(left[2], left[0] + 0.3f);
  EXPECT_GT(right[0], right[2] + 0.3f);
}

// How many pixels of a row have a colour.
int count_in_row(const Image& canvas, const Rect& row, const images::Rgb& color) {
  int count = 0;
  for (int x = row.x; x < row.x + row.width; ++x)
    count += std::equal(color.begin(), color.end(), canvas.at(x, row.y)) ? 1 : 0;
  return count;
}

TEST(Grid, BarsLengths_AreInPixelsOfOneScale) {
  Grid grid = make_grid(3, 96, 54);
  grid.tiles[1].attribution = AttributionBar{{0.0, 0.03, 0.0, 0.01}};
  grid.tiles[2].attribution = AttributionBar{{0.0, 0.015, -0.02, 0.02}};
  const GridLayout layout = layout_grid(grid);
  const Image canvas = draw_grid(grid);
  ASSERT_EQ(layout.bars.size(), 2u);
  EXPECT_DOUBLE_EQ(layout.bar_scale->length, 0.06);
  for (const BarPlace& bar : layout.bars) {
    const records::PartValues& lengths = grid.tiles[bar.tile].attribution->lengths;
    const Rect row{bar.track.x, bar.track.y + bar.track.height / 2, bar.track.width, 1};
    for (std::size_t part = 0; part < metrics::kErrorParts; ++part) {
      const double expected = std::abs(lengths[part]) / layout.bar_scale->length * bar.track.width;
      EXPECT_NEAR(count_in_row(canvas, row, records::list_error_parts()[part].color), expected, 3.5)
          << part;  // the tick hides 3
    }
    EXPECT_NEAR(bar.zero_line.x, bar.track.x + bar.track.width / 3.0, 1.0);
    EXPECT_EQ(count_in_row(canvas, bar.net_tick, images::Rgb{0.0f, 0.0f, 0.0f}), bar.net_tick.width);
  }
}

TEST(Grid, Bars_LieBetweenTheErrorAndTheCrop) {
  const Grid grid = make_attributed_grid(3, 96, 54);
  const GridLayout layout = layout_grid(grid);
  ASSERT_FALSE(layout.bars.empty());
  for (const BarPlace& bar : layout.bars) {
    for (const Panel& panel : layout.panels) {
      const bool is_crop = panel.kind == PanelKind::kPictureCrop || panel.kind == PanelKind::kVisibilityCrop;
      EXPECT_EQ(panel.box.y > bar.box.y, is_crop);
    }
  }
}

TEST(Grid, BarsLegend_NamesThePartsBesideTheirColoursAndTheLength) {
  const Grid grid = make_attributed_grid(4, 96, 54);
  const std::string text = all_text(grid);
  EXPECT_THAT(text, HasSubstr("thefullwidth0.06"));
  EXPECT_THAT(text, HasSubstr("estimator83%,model28%"));
  const GridLayout layout = layout_grid(grid);
  const Image canvas = draw_grid(grid);
  ASSERT_EQ(layout.swatches.size(), metrics::kErrorParts);
  for (const Swatch& swatch : layout.swatches) {
    const images::Rgb& color = records::list_error_parts()[swatch.part].color;
    EXPECT_EQ(count_in_row(canvas, swatch.box, color), swatch.box.width);
    EXPECT_TRUE(std::any_of(layout.texts.begin(), layout.texts.end(), [&](const TextLine& line) {
      return line.text == records::list_error_parts()[swatch.part].name && line.box.y == swatch.box.y;
    }));
  }
}

TEST(Grid, BarsLength_IsWrittenWithoutRoundingErrors) {
  Grid grid = make_grid(1, 96, 54);
  grid.tiles[0].attribution = AttributionBar{{0.0, 0.3, 0.0, 0.0}};
  EXPECT_THAT(all_text(grid), HasSubstr("thefullwidth0.3."));
}

TEST(Grid, ReasonForNoBar_IsSaidOnlyWhereThereAreBars) {
  Grid grid = make_attributed_grid(4, 96, 54);
  EXPECT_THAT(all_text(grid), HasSubstr("noattribution:thisfilterhasnoscalarmodel"));
  for (GridTile& tile : grid.tiles) tile.attribution.reset();
  EXPECT_THAT(all_text(grid), Not(HasSubstr("noattribution")));
  EXPECT_TRUE(layout_grid(grid).swatches.empty());
}

TEST(Grid, GivenErrorScale_IsTaken) {
  Grid grid = make_attributed_grid(3, 96, 54);
  grid.error_scale = 0.7;
  EXPECT_DOUBLE_EQ(layout_grid(grid).error_scale, 0.7);
  EXPECT_THAT(all_text(grid), HasSubstr("-0.7(toodark,blue)to+0.7"));
}

}  // namespace
}  // namespace shadowbench::images
