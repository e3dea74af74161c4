#include "report/pages/grid_sheets.h"

#include <gmock/gmock.h>

#include "report/images/picture_io.h"
#include "tests/report/records/synthetic.h"

namespace shadowbench::pages {
namespace {

using records::CellRecord;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

constexpr int kWidth = 200, kHeight = 120;

/// A report folder of one view, whose filters blur an edge by as many pixels as their numbers say.
class GridFolder {
 public:
  const std::filesystem::path& path() const { return folder_.path(); }
  std::vector<CellRecord> cells;

  void add(const std::string& filter, float softness, std::optional<double> rmse) {
    CellRecord cell = records::make_cell("cubes", filter, 4.0);
    cell.error.rmse = rmse;
    if (rmse) cell.absent.erase("error");
    cell.images = {};
    cell.images.grid = "cubes.grid.png";
    cell.images.exr = "cubes.exr";
    cell.images.parts = filter;
    cell.images.picture = filter + ".png";
    cell.images.truth_picture = "truth.png";
    const images::Image visibility = records::make_visibility(kWidth, kHeight, softness);
    images::write_picture_png(path() / *cell.images.picture, records::shade(visibility));
    parts_.push_back({filter + ".visibility", {"Y"}, visibility});
    cells.push_back(cell);
  }

  void write(bool with_truth = true) const {
    std::vector<images::Part> parts = parts_;
    const images::Image truth = records::make_visibility(kWidth, kHeight, 5.0f);
    images::write_picture_png(path() / "truth.png", records::shade(truth));
    images::Image mask(kWidth, kHeight, 1);
    std::ranges::fill(mask.texels, 1.0f);
    if (with_truth) {
      parts.push_back({"truth.area", {"Y"}, truth});
      parts.push_back({"truth.mask", {"Y"}, mask});
    }
    images::write_exr(path() / "cubes.exr", parts, {});
  }

  std::vector<images::Sheet> make() const {
    const std::vector<analysis::CellGroup> groups = analysis::group_cells(cells);
    return make_sheets(path(), groups.at(0), list_grid_words(cells, records::make_run().gl));
  }

 private:
  TestFolder folder_;
  std::vector<images::Part> parts_;
};

std::vector<std::string> list_names(const images::Sheet& sheet) {
  std::vector<std::string> names;
  for (const images::SheetTile& tile : sheet.filters) names.push_back(tile.name);
  return names;
}

TEST(GridSheets, FiltersStandByTheirErrors_WithBarsOfOneScale_SuspectsBehind) {
  GridFolder folder;
  folder.add("none", 0.1f, 0.08);
  folder.add("pcss", 4.0f, 0.02);
  folder.add("broken", 30.0f, 0.001);
  folder.cells.back().status = records::CellStatus::kSuspect;
  folder.add("vsm", 12.0f, 0.04);
  folder.write();
  const std::vector<images::Sheet> sheets = folder.make();
  ASSERT_EQ(sheets.size(), 1u);
  const images::Sheet& sheet = sheets.front();
  EXPECT_THAT(list_names(sheet), ElementsAre("pcss", "vsm", "none", "broken"));
  EXPECT_EQ(sheet.filters[0].number, "0.020");
  EXPECT_DOUBLE_EQ(sheet.filters[0].bar.value(), 0.25);
  EXPECT_DOUBLE_EQ(sheet.filters[2].bar.value(), 1.0);
  EXPECT_EQ(sheet.filters[3].number, "");
  EXPECT_THAT(sheet.filters[3].message, HasSubstr("suspect"));
  EXPECT_THAT(sheet.filters[0].words, HasSubstr("7.5 ms"));
  EXPECT_FALSE(sheet.filters[0].inset.empty());
  EXPECT_EQ(sheet.truth.name, "ray-traced truth");
}

TEST(GridSheets, TheCrop_IsWhereFiltersDiffer_AndIsCutFromThePictures) {
  GridFolder folder;
  folder.add("none", 0.1f, 0.08);
  folder.add("vsm", 12.0f, 0.04);
  folder.write();
  const images::Sheet sheet = folder.make().front();
  const images::Rect crop = sheet.crop;
  EXPECT_EQ(crop.width, images::kSheetCrop.width);
  const int middle = crop.y + crop.height / 2;
  const int edge = static_cast<int>(0.4 * kWidth + 0.3 * middle);
  EXPECT_TRUE(edge > crop.x && edge < crop.x + crop.width) << crop.x;
  const images::Image picture = images::read_picture(folder.path() / "none.png");
  const images::SheetTile& none = sheet.filters[1];
  EXPECT_EQ(none.crop.at(3, 4)[1], picture.at(crop.x + 3, crop.y + 4)[1]);
}

TEST(GridSheets, ThePicks_HaveTheirRoles_AndASingleFilterHasNone) {
  GridFolder folder;
  folder.add("none", 0.1f, 0.08);
  folder.write();
  EXPECT_EQ(folder.make().front().filters[0].role, "");
  folder.add("pcss", 4.0f, 0.02);
  folder.write();
  const images::Sheet sheet = folder.make().front();
  EXPECT_EQ(sheet.filters[0].name, "pcss");
  EXPECT_NE(sheet.filters[0].role, "");
}

TEST(GridSheets, WithoutTruthOrCost_SaysWhy) {
  GridFolder folder;
  folder.add("none", 0.1f, std::nullopt);
  folder.cells.back().time_ms = {};
  folder.write(false);
  const images::Sheet sheet = folder.make().front();
  EXPECT_EQ(sheet.truth.name, "no truth");
  EXPECT_EQ(sheet.truth.message, "no truth in this run");
  EXPECT_EQ(sheet.filters[0].words, "");
  EXPECT_FALSE(sheet.filters[0].bar.has_value());
  EXPECT_TRUE(sheet.filters[0].inset.empty());
  EXPECT_FALSE(sheet.filters[0].crop.empty());
}

TEST(GridSheets, ThirtyOneFilters_TakeFourSheets_WithOneCropAndScale) {
  GridFolder folder;
  for (int i = 0; i < 31; ++i)
    folder.add("filter_whose_name_has_sixty_letters_or_nearly_as_many_as_" + std::to_string(i),
               1.0f + static_cast<float>(i), 0.01 * (i + 1));
  folder.write();
  write_grids(folder.path(), folder.cells, records::make_run().gl, {960.0});
  std::size_t shown = 0;
  for (const images::Sheet& sheet : folder.make()) {
    shown += sheet.filters.size();
    EXPECT_EQ(sheet.crop.x, folder.make().front().crop.x);
  }
  EXPECT_EQ(shown, 31u);
  const std::vector<std::string> files = list_sheets("cubes.grid.png", 31);
  EXPECT_THAT(files, ElementsAre("cubes.grid.png", "cubes.grid.2.png", "cubes.grid.3.png", "cubes.grid.4.png"));
  for (const std::string& file : files) EXPECT_LE(images::read_picture(folder.path() / file).width, 960);
}

TEST(GridSheets, ImagesThatCannotBeRead_AreSaid_AndWithoutAnyThereIsNoGrid) {
  GridFolder folder;
  folder.add("none", 0.1f, 0.08);
  folder.add("vsm", 4.0f, 0.02);
  folder.write();
  folder.cells[1].images.parts = "other";
  folder.cells[1].images.picture = "other.png";
  EXPECT_THAT(folder.make().front().filters[0].message, HasSubstr("cannot be read"));
  std::filesystem::remove(folder.path() / "cubes.exr");
  EXPECT_TRUE(folder.make().empty());
  write_grids(folder.path(), folder.cells, records::make_run().gl);
  EXPECT_FALSE(std::filesystem::exists(folder.path() / "cubes.grid.png"));
}

}  // namespace
}  // namespace shadowbench::pages
