// The report of cells that several kinds of machine measured.

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>
#include <regex>

#include "report/analysis/findings.h"
#include "report/pages/write_page.h"
#include "report/records/json_io.h"
#include "tests/report/analysis/mixed_cells.h"

namespace shadowbench::pages {

using namespace analysis;
using namespace records;
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;

std::string write_and_read(const std::vector<CellRecord>& cells, const RunRecord& run, const std::string& file) {
  const TestFolder folder;
  std::vector<std::string> keys;
  for (const CellRecord& cell : cells) {
    write_cell(folder.path(), cell);
    keys.push_back(cell.key);
  }
  write_report(folder.path(), run, keys);
  return read_text(folder.path() / file);
}

/// Whether a text says a number of milliseconds.
bool says_milliseconds(const std::string& text) { return std::regex_search(text, std::regex("[0-9] ms")); }

TEST(MixedMachines, NoTimeIsSaid_ButInTheTablesOfMeasurements) {
  const std::string summary = write_and_read(make_mixed_cells(), make_run(), "details.md");
  EXPECT_FALSE(says_milliseconds(summary)) << summary;
  EXPECT_THAT(summary, HasSubstr("Nothing fits: none of 3 configurations can be judged"));
  EXPECT_THAT(summary, HasSubstr("A fast CPU, 64 cores, A GPU, GPU time (timer query) (1 cell)"));
  EXPECT_THAT(write_and_read(make_mixed_cells(), make_run(), "timings.csv"),
              HasSubstr("\"A fast CPU, 64 cores, A GPU, GPU time (timer query)\""));
  std::vector<CellRecord> alike = make_mixed_cells();
  for (CellRecord& cell : alike) cell.machine = make_kind("A CPU");
  const std::string usual = write_and_read(alike, make_run(), "details.md");
  EXPECT_TRUE(says_milliseconds(usual));
  EXPECT_THAT(usual, Not(HasSubstr("Several kinds")));
}

TEST(MixedMachines, OneWarningSaysSo_AlsoWhereTheReportIsWrittenAgain) {
  RunRecord run = make_run();
  run.warnings = {"another", warn_of_mixed_machines(make_mixed_cells())};
  const auto results = nlohmann::json::parse(write_and_read(make_mixed_cells(), run, "results.json"));
  EXPECT_THAT(results["warnings"], ElementsAre(warn_of_mixed_machines(make_mixed_cells()), "another"));
  EXPECT_FALSE(results["cells"][2]["time_ms"]["moving"].is_null()) << "records keep what was measured";
}

}  // namespace
}  // namespace shadowbench::pages
