#include "report/report.h"

#include <algorithm>

#include "report/atomic_file.h"
#include "report/html.h"
#include "report/json_io.h"
#include "report/tables.h"
#include "report/trade_section.h"

namespace shadowbench::report {

namespace {

/// What a run warns of is what concerns all of it, then what concerns its cells; each said once.
void add_warnings(RunRecord& run, const std::vector<CellRecord>& cells) {
  for (const CellRecord& cell : cells) {
    for (const std::string& warning : cell.warnings)
      if (std::find(run.warnings.begin(), run.warnings.end(), warning) == run.warnings.end())
        run.warnings.push_back(warning);
  }
}

}  // namespace

void write_report(const std::filesystem::path& dir, RunRecord run, const std::vector<std::string>& keys) {
  std::vector<CellRecord> cells;
  for (const std::string& key : keys) cells.push_back(read_cell(dir, key));
  add_warnings(run, cells);
  write_text_file(dir / "timings.csv", make_csv(CsvTable::kTimings, run, cells));
  write_text_file(dir / "accuracy.csv", make_csv(CsvTable::kAccuracy, run, cells));
  std::optional<Trade> trade = make_trade(run, cells);
  if (trade) trade = write_trade_files(dir, cells, std::move(*trade));
  write_text_file(dir / "summary.md", make_summary(run, cells, trade ? make_trade_markdown(run, cells, *trade) : ""));
  write_text_file(dir / "index.html", make_index_html(run, cells, trade ? make_trade_html(run, cells, *trade) : ""));
  write_results(dir, run, keys);
}

}  // namespace shadowbench::report
