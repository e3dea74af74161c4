#include "report/report.h"

#include "report/atomic_file.h"
#include "report/html.h"
#include "report/json_io.h"
#include "report/tables.h"

namespace shadowbench::report {

void write_report(const std::filesystem::path& dir, const RunRecord& run, const std::vector<std::string>& keys) {
  write_results(dir, run, keys);
  std::vector<CellRecord> cells;
  for (const std::string& key : keys) {
    cells.push_back(read_cell(dir, key));
  }
  write_text_file(dir / "timings.csv", make_csv(CsvTable::kTimings, run, cells));
  write_text_file(dir / "accuracy.csv", make_csv(CsvTable::kAccuracy, run, cells));
  write_text_file(dir / "summary.md", make_summary(run, cells));
  write_text_file(dir / "index.html", make_index_html(run, cells));
}

}  // namespace shadowbench::report
