#include "report/pages/write_report.h"

#include <algorithm>

#include "filters/base/atomic_file.h"
#include "report/pages/fronts_csv.h"
#include "report/pages/run_page.h"
#include "report/pages/write_page.h"
#include "report/records/csv_tables.h"
#include "report/records/json_io.h"

namespace shadowbench::pages {

namespace {

/// Adds the warnings of the cells to those of the run, each once.
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
  write_text_file(dir / "timings.csv", records::make_csv(records::CsvTable::kTimings, run, cells));
  write_text_file(dir / "accuracy.csv", records::make_csv(records::CsvTable::kAccuracy, run, cells));
  const std::optional<Trade> trade = make_trade(cells);
  if (trade && trade->has_fronts) write_text_file(dir / "fronts.csv", make_fronts_csv(cells, trade->scopes));
  write_page(dir, "run", make_run_page(run, cells, trade));
  records::write_results(dir, run, keys);
}

}  // namespace shadowbench::pages
