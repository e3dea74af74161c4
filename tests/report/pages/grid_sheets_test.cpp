#include "report/pages/grid_sheets.h"

#include <nlohmann/json.hpp>

#include "report/images/picture_io.h"
#include "report/pages/frames_page.h"
#include "tests/report/pages/answer.h"
#include "tests/report/records/synthetic.h"

namespace shadowbench::pages {
namespace {

using records::CellRecord;

constexpr int kWidth = 200, kHeight = 120;

/// A report folder of one view, whose filters blur an edge by as many pixels as their numbers say.
class GridSheets : public records::FolderTest {
 protected:
  const std::filesystem::path& path() const { return folder_.path(); }
  std::vector<CellRecord> cells_;

  void add(const std::string& filter, float softness, std::optional<double> rmse) {
    CellRecord cell =
        rmse ? records::make_scored_cell("cubes", filter, 4.0, *rmse) : records::make_cell("cubes", filter, 4.0);
    cell.images = {};
    cell.images.grid = "cubes.grid.png";
    cell.images.exr = "cubes.exr";
    cell.images.parts = filter;
    cell.images.picture = filter + ".png";
    cell.images.truth_picture = "truth.png";
    const images::Image visibility = records::make_visibility(kWidth, kHeight, softness);
    images::write_picture_png(path() / *cell.images.picture, records::shade(visibility));
    parts_.push_back({filter + ".visibility", {"Y"}, visibility});
    cells_.push_back(cell);
  }

  void write(bool with_truth = true) const {
    std::vector<images::Part> parts = parts_;
    const images::Image truth = records::make_visibility(kWidth, kHeight, 5.0f);
    images::write_picture_png(path() / "truth.png", records::shade(truth));
    if (with_truth) {
      parts.push_back({"truth.area", {"Y"}, truth});
      parts.push_back({"truth.mask", {"Y"}, records::fill(images::Image(kWidth, kHeight, 1), 1.0f)});
    }
    images::write_exr(path() / "cubes.exr", parts, {});
  }

  std::vector<images::Sheet> make() const {
    const std::vector<analysis::CellGroup> groups = analysis::group_cells(cells_);
    return make_sheets(path(), groups.at(0), list_grid_words(cells_, records::make_run().gl));
  }

 private:
  std::vector<images::Part> parts_;
};

std::vector<std::string> list_names(const images::Sheet& sheet) {
  return records::list_each(sheet.filters, &images::SheetTile::name);
}

TEST_F(GridSheets, FiltersStandByTheirErrors_WithBarsOfOneScale_SuspectsBehind) {
  add("none", 0.1f, 0.08);
  add("pcss", 4.0f, 0.02);
  add("broken", 30.0f, 0.001);
  cells_.back().status = records::CellStatus::kSuspect;
  add("vsm", 12.0f, 0.04);
  write();
  const std::vector<images::Sheet> sheets = make();
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

TEST_F(GridSheets, TheCrop_IsWhereFiltersDiffer_AndIsCutFromThePictures) {
  add("none", 0.1f, 0.08);
  add("vsm", 12.0f, 0.04);
  write();
  const images::Sheet sheet = make().front();
  const images::Rect crop = sheet.crop;
  EXPECT_EQ(crop.width, images::kSheetCrop.width);
  const int middle = crop.y + crop.height / 2;
  const int edge = static_cast<int>(0.4 * kWidth + 0.3 * middle);
  EXPECT_TRUE(edge > crop.x && edge < crop.x + crop.width) << crop.x;
  const images::Image picture = images::read_picture(path() / "none.png");
  const images::SheetTile& none = sheet.filters[1];
  EXPECT_EQ(none.crop.at(3, 4)[1], picture.at(crop.x + 3, crop.y + 4)[1]);
}

TEST_F(GridSheets, ThePicks_HaveTheirRoles_AndASingleFilterHasNone) {
  add("none", 0.1f, 0.08);
  write();
  EXPECT_EQ(make().front().filters[0].role, "");
  add("pcss", 4.0f, 0.02);
  write();
  const images::Sheet sheet = make().front();
  EXPECT_EQ(sheet.filters[0].name, "pcss");
  EXPECT_NE(sheet.filters[0].role, "");
}

TEST_F(GridSheets, WithoutTruthOrCost_SaysWhy) {
  add("none", 0.1f, std::nullopt);
  cells_.back().time_ms = {};
  write(false);
  const images::Sheet sheet = make().front();
  EXPECT_EQ(sheet.truth.name, "no truth");
  EXPECT_EQ(sheet.truth.message, "no truth in this run");
  EXPECT_EQ(sheet.filters[0].words, "");
  EXPECT_FALSE(sheet.filters[0].bar.has_value());
  EXPECT_TRUE(sheet.filters[0].inset.empty());
  EXPECT_FALSE(sheet.filters[0].crop.empty());
}

TEST_F(GridSheets, ThirtyOneFilters_TakeFourSheets_WithOneCropAndScale) {
  for (int i = 0; i < 31; ++i)
    add("filter_whose_name_has_sixty_letters_or_nearly_as_many_as_" + std::to_string(i), 1.0f + static_cast<float>(i),
        0.01 * (i + 1));
  write();
  write_grids(path(), cells_, records::make_run().gl, {960.0});
  std::size_t shown = 0;
  for (const images::Sheet& sheet : make()) {
    shown += sheet.filters.size();
    EXPECT_EQ(sheet.crop.x, make().front().crop.x);
  }
  EXPECT_EQ(shown, 31u);
  const std::vector<std::string> files = list_sheets("cubes.grid.png", 31);
  EXPECT_THAT(files, ElementsAre("cubes.grid.png", "cubes.grid.2.png", "cubes.grid.3.png", "cubes.grid.4.png"));
  for (const std::string& file : files) EXPECT_LE(images::read_picture(path() / file).width, 960);
}

TEST_F(GridSheets, ImagesThatCannotBeRead_AreSaid_AndWithoutAnyThereIsNoGrid) {
  add("none", 0.1f, 0.08);
  add("vsm", 4.0f, 0.02);
  write();
  cells_[1].images.parts = "other";
  cells_[1].images.picture = "other.png";
  EXPECT_THAT(make().front().filters[0].message, HasSubstr("cannot be read"));
  std::filesystem::remove(path() / "cubes.exr");
  EXPECT_TRUE(make().empty());
  write_grids(path(), cells_, records::make_run().gl);
  EXPECT_FALSE(std::filesystem::exists(path() / "cubes.grid.png"));
}

// Which taps at which frame count equal 16 taps in one frame, from records made by hand.

/// A cell whose noise, and error above 0.1, falls with the root of the frames from this value on.
records::CellRecord make_accumulated(double taps, const std::string& rotation, double noise) {
  records::CellRecord cell;
  cell.key = fmt::format("{:016x}", static_cast<int>(1e6 * noise));
  cell.scene = "ball";
  cell.view = "main";
  cell.filter = "poisson";
  cell.params = {{"taps", taps}, {"rotation", rotation}};
  cell.accumulation.emplace();
  for (const bool jitter : {false, true}) {
    for (const char* rule : {"newest", "mean", "exponential", "clamped"}) {
      records::ResolveRecord& resolve = cell.accumulation->resolves.emplace_back();
      resolve.rule = rule;
      resolve.jitter = jitter;
      resolve.noise.emplace();
      for (int n = 1; n <= 8; ++n) {
        resolve.noise->push_back(noise / std::sqrt(n));
        resolve.rmse.push_back(0.1 + noise / std::sqrt(n));
      }
    }
  }
  return cell;
}

std::vector<records::CellRecord> make_accumulated_cells() {
  return {make_accumulated(4, "per-pixel", 0.02),  make_accumulated(16, "per-pixel", 0.0101),
          make_accumulated(4, "blue-noise", 0.04), make_accumulated(16, "blue-noise", 0.01),
          make_accumulated(32, "other", 0.001),    make_accumulated(16, "none", 0.0),
          make_accumulated(4, "none", 0.0)};
}

TEST(FramesPage, CountsFramesUntilTheyEqualSixteenTaps_OfTheSameRotation) {
  const auto groups = analysis::group_cells(make_accumulated_cells());
  ASSERT_EQ(groups.size(), 1u);
  const std::vector<TapEquivalence> list = list_equivalences(groups.front());
  ASSERT_EQ(list.size(), 4u) << "without 16 taps of its rotation that have noise a cell equals nothing";
  EXPECT_EQ(list[0].taps, 4);
  EXPECT_EQ(list[0].by_noise, 4);
  EXPECT_EQ(list[0].by_error, 4);
  EXPECT_EQ(list[1].by_noise, 1);
  EXPECT_EQ(list[2].by_noise, std::nullopt) << "16 frames are needed, and there are 8";
}

TEST(FramesPage, SaysIt) {
  const std::string text = document::write_markdown(make_frames_page(make_accumulated_cells(), {}));
  EXPECT_THAT(text, HasSubstr("4 taps have the noise of 16 taps in one frame after 4 frames, and after more than 8: "
                              "poisson (rotation blue-noise, taps 4)."));
  EXPECT_THAT(text, HasSubstr("more than 8"));
  const std::string alone = document::write_markdown(make_frames_page({make_accumulated(4, "none", 0.1)}, {}));
  EXPECT_THAT(alone, HasSubstr("Over 8 frames, poisson gains most: its noise on ball goes from 0.1 to 0.0354."));
}

TEST(FramesPage, ItsFirstChart_IsNeverEmpty) {
  const auto find_first = [](const std::vector<records::CellRecord>& cells) {
    return document::find_block<document::ChartChoice>(make_frames_page(cells, {}).sections.front().blocks)->charts[0];
  };
  EXPECT_EQ(find_first(make_accumulated_cells()).y_name, "noise");
  const document::Chart still = find_first({make_accumulated(4, "none", 0.0)});
  EXPECT_EQ(still.y_name, "RMSE");
  EXPECT_FALSE(still.series.empty());
}

/// What is measured of frames is written, and read again; a cell without it says nothing of it.
TEST(FramesPage, RecordsAreReadAgain) {
  records::CellRecord cell = make_accumulated_cells().front();
  cell.accumulation->ghosts = {{4.0, "clamped", 7, 0.5, 3}, {4.0, "exponential", 0, {}, {}}};
  const nlohmann::json json = records::to_json(cell);
  EXPECT_EQ(records::to_json(records::cell_from_json(json, "here")), json);
  cell.accumulation.reset();
  EXPECT_FALSE(records::to_json(cell).contains("accumulation"));
}

TEST(FramesPage, RecordsThatLackARule_AreBadInput) {
  records::CellRecord cell = make_accumulated_cells().front();
  cell.accumulation->resolves.clear();
  EXPECT_THROW(make_frames_page({cell}, {}), Error);
}

TEST(FramesPage, OfAnotherRunIntoTheFolder_IsRemoved) {
  const TestFolder folder;
  records::CellRecord cell = make_accumulated(4, "blue-noise", 0.25);
  write_report(folder.path(), {}, std::vector{cell});
  EXPECT_TRUE(std::filesystem::exists(folder.path() / "frames.html"));
  cell.accumulation.reset();
  write_report(folder.path(), {}, std::vector{cell});
  for (const char* name : {"frames.html", "frames.md"}) EXPECT_FALSE(std::filesystem::exists(folder.path() / name));
}

}  // namespace
}  // namespace shadowbench::pages
