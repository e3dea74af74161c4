#include "report/pages/report.h"

#include <algorithm>

#include "report/files/atomic_file.h"
#include "report/pages/html.h"
#include "report/pages/tables.h"
#include "report/pages/trade_section.h"
#include "report/records/json_io.h"

namespace shadowbench::pages {

namespace {

/// What a run warns of is what concerns all of it, then what concerns its cells; each said once.
void add_warnings(records::RunRecord& run, const std::vector<records::CellRecord>& cells) {
  for (const records::CellRecord& cell : cells) {
    for (const std::string& warning : cell.warnings)
      if (std::find(run.warnings.begin(), run.warnings.end(), warning) == run.warnings.end())
        run.warnings.push_back(warning);
  }
}

}  // namespace

void write_report(const std::filesystem::path& dir, records::RunRecord run, const std::vector<std::string>& keys) {
  std::vector<records::CellRecord> cells;
  for (const std::string& key : keys) cells.push_back(records::read_cell(dir, key));
  add_warnings(run, cells);
  files::write_text_file(dir / "timings.csv", make_csv(CsvTable::kTimings, run, cells));
  files::write_text_file(dir / "accuracy.csv", make_csv(CsvTable::kAccuracy, run, cells));
  std::optional<Trade> trade = make_trade(run, cells);
  if (trade) trade = write_trade_files(dir, cells, std::move(*trade));
  files::write_text_file(dir / "summary.md",
                         make_summary(run, cells, trade ? make_trade_markdown(run, cells, *trade) : ""));
  files::write_text_file(dir / "index.html",
                         make_index_html(run, cells, trade ? make_trade_html(run, cells, *trade) : ""));
  records::write_results(dir, run, keys);
}

}  // namespace shadowbench::pages
