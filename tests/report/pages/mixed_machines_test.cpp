// The report of cells that several kinds of machine measured.

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>
#include <regex>

#include "report/analysis/machines/machine_kinds.h"
#include "report/pages/answer/advice_text.h"
#include "report/pages/run_page.h"
#include "report/pages/write_report.h"
#include "report/records/json_io.h"
#include "tests/report/analysis/mixed_cells.h"

namespace shadowbench::pages {

using namespace analysis;
using namespace records;
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

std::string write_and_read(const std::vector<CellRecord>& cells, const RunRecord& run, const std::string& file) {
  const TemporaryFolder folder("mixed_machines");
  std::vector<std::string> keys;
  for (const CellRecord& cell : cells) {
    write_cell(folder.path(), cell);
    keys.push_back(cell.key);
  }
  write_report(folder.path(), run, keys);
  return read_text(folder.path() / file);
}

/// Whether a text says a number of milliseconds.
bool says_milliseconds(const std::string& text) { return std::regex_search(text, std::regex("[0-9] ms|, ms|ms \\(")); }

TEST(MixedMachines, NothingIsSaidInMilliseconds_ButInTheTablesOfEachScene) {
  const std::string summary = write_and_read(make_mixed_cells(), make_run(), "summary.md");
  const std::size_t evidence = summary.find("## Behind the numbers");
  ASSERT_NE(evidence, std::string::npos);
  EXPECT_FALSE(says_milliseconds(summary.substr(0, summary.find("### Columns of fronts.csv"))));
  EXPECT_THAT(summary, HasSubstr("lowest ratio to 'none'"));
  EXPECT_THAT(summary.substr(evidence), HasSubstr("| machine |"));
  EXPECT_THAT(summary.substr(evidence), HasSubstr("| 80 \\[79.2, 80.8\\] ")) << "as it was measured";
  EXPECT_THAT(summary.substr(evidence), HasSubstr("A fast CPU, 64 cores, A GPU, GPU time (timer query) (1 cell)"));
  std::vector<CellRecord> alike = make_mixed_cells();
  for (CellRecord& cell : alike) cell.machine = make_kind("A CPU");
  const std::string usual = write_and_read(alike, make_run(), "summary.md");
  EXPECT_TRUE(says_milliseconds(usual.substr(0, usual.find("### Columns of fronts.csv"))));
  EXPECT_THAT(usual, Not(HasSubstr("| machine |")));
  EXPECT_THAT(usual, Not(HasSubstr("Several kinds")));
}

TEST(MixedMachines, OneWarningSaysSo_AlsoWhereShardsWarnedBefore) {
  RunRecord run = make_run();
  run.warnings = {warn_of_mixed_machines({{make_kind("X"), 1}, {make_kind("Y"), 2}}), "another"};
  const auto results = nlohmann::json::parse(write_and_read(make_mixed_cells(), run, "results.json"));
  EXPECT_THAT(results["warnings"], ElementsAre(warn_of_mixed_machines(count_machines(make_mixed_cells())), "another"));
  EXPECT_FALSE(results["cells"][2]["time_ms"]["moving"].is_null()) << "records keep what was measured";
}

TEST(MixedMachines, ThePagesScriptsReadRatios) {
  const std::vector<CellRecord> cells = make_mixed_cells();
  const document::Page page = make_run_page(make_run(), cells, make_trade(cells));
  const nlohmann::json& data = page.data;
  EXPECT_EQ(data["ratios"], true);
  EXPECT_EQ(data["measures"][0]["unit"], "× none");
  EXPECT_EQ(data["measures"][0]["option"], "");
  EXPECT_EQ(data["cells"][2]["values_of"]["ratio_to_none.moving"], 3.0);
  EXPECT_EQ(data["cells"][2]["intervals"]["ratio_to_none.static"], nlohmann::json({3.0 * 0.99, 3.0 * 1.01}));
  EXPECT_EQ(data["configurations"][2]["ratio_to_none.moving"], 3.0);
}

TEST(MixedMachines, FrontsAreDrawnAndWrittenOfRatios) {
  const std::vector<CellRecord> cells = make_mixed_cells();
  const document::Section section = make_trade_section(make_run(), *withhold_mixed_times(cells), *make_trade(cells));
  for (const document::Block& block : section.blocks) {
    const auto* choice = std::get_if<document::ChartChoice>(&block);
    if (!choice) continue;
    EXPECT_EQ(choice->charts[0].id, "cubes.main.960x540.rmse.moving_ratio");
    EXPECT_EQ(choice->charts[0].x_name, "ratio to 'none' on the same map, moving light");
  }
  EXPECT_THAT(write_and_read(cells, make_run(), "fronts.csv"), HasSubstr(",rmse,moving_ratio," + cells[2].key));
  EXPECT_THAT(write_and_read(cells, make_run(), "timings.csv"),
              HasSubstr("\"A fast CPU, 64 cores, A GPU, GPU time (timer query)\""));
}

TEST(MixedMachines, AdviceHasRatiosAlone) {
  const std::vector<CellRecord> cells = *withhold_mixed_times(make_mixed_cells());
  const std::string text = make_advice_text(make_run(), advise(cells, {}));
  EXPECT_THAT(text, HasSubstr("slow: 2 × none a frame, moving light; lowest ratio to 'none' of 1 on the front"));
  EXPECT_FALSE(says_milliseconds(text)) << text;
  const auto json = make_advice_json(make_run(), advise(cells, {}));
  EXPECT_EQ(json["asked"]["cheapest"], "ratio_to_none");
  EXPECT_EQ(json["time_unit"], "× none");
  EXPECT_TRUE(json["advised"]["cells"][0]["time_ms"].is_null());
}

}  // namespace
}  // namespace shadowbench::pages
