// Which taps at which frame count equal 16 taps in one frame, from records made by hand.

#include "report/pages/frames_page.h"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/files.h"
#include "report/pages/write_page.h"
#include "report/records/json_io.h"

namespace shadowbench::pages {
namespace {

using ::testing::HasSubstr;

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
    const document::Page page = make_frames_page(cells, {});
    for (const document::Block& block : page.sections.front().blocks)
      if (const auto* choice = std::get_if<document::ChartChoice>(&block)) return choice->charts.front();
    return document::Chart();
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
  const ScratchFolder folder(make_temporary_folder_path(std::filesystem::temp_directory_path() / "frames", "test"));
  records::CellRecord cell = make_accumulated(4, "blue-noise", 0.25);
  write_report(folder.path(), {}, std::vector{cell});
  EXPECT_TRUE(std::filesystem::exists(folder.path() / "frames.html"));
  cell.accumulation.reset();
  write_report(folder.path(), {}, std::vector{cell});
  for (const char* name : {"frames.html", "frames.md"}) EXPECT_FALSE(std::filesystem::exists(folder.path() / name));
}

}  // namespace
}  // namespace shadowbench::pages
