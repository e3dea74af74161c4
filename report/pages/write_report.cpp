#include "report/pages/write_report.h"

#include <algorithm>

#include "base/files.h"
#include "report/analysis/cell_group.h"
#include "report/analysis/summary.h"
#include "report/pages/frames_page.h"
#include "report/pages/fronts_csv.h"
#include "report/pages/grid_sheets.h"
#include "report/pages/run_page.h"
#include "report/pages/write_page.h"
#include "report/records/bias_record.h"
#include "report/records/csv_tables.h"
#include "report/records/json_io.h"

namespace shadowbench::pages {

namespace {

/// Adds the warnings of the cells to those of the run, each once, and that of their machines.
void add_warnings(records::RunRecord& run, const std::vector<records::CellRecord>& cells) {
  for (const records::CellRecord& cell : cells) {
    for (const std::string& warning : cell.warnings)
      if (std::find(run.warnings.begin(), run.warnings.end(), warning) == run.warnings.end())
        run.warnings.push_back(warning);
  }
  if (!analysis::mixes_machines(cells)) return;
  const std::string warning = analysis::warn_of_mixed_machines(cells);
  std::erase(run.warnings, warning);
  run.warnings.insert(run.warnings.begin(), warning);
}

}  // namespace

void write_report(const std::filesystem::path& dir, records::RunRecord run, const std::vector<std::string>& keys) {
  write_report(dir, std::move(run), records::read_cells(dir, keys));
}

void write_report(const std::filesystem::path& dir, records::RunRecord run,
                  const std::vector<records::CellRecord>& cells, images::SheetWidth width) {
  const std::vector<records::GpuTimes> machines = records::list_gpu_times(dir, cells, run.warnings);
  const std::vector<records::BiasToShip> biases = records::list_bias_to_ship(dir, run.warnings);
  add_warnings(run, cells);
  write_text_file(dir / "timings.csv", records::make_csv(records::CsvTable::kTimings, run, cells));
  write_text_file(dir / "accuracy.csv", records::make_csv(records::CsvTable::kAccuracy, run, cells));
  const auto withheld = analysis::withhold_mixed_times(cells);
  const std::vector<records::CellRecord>& shown = withheld ? *withheld : cells;
  const auto without_external = analysis::leave_out_external(shown);
  const std::vector<records::CellRecord>& own = without_external ? *without_external : shown;
  const std::optional<Trade> trade = make_trade(own);
  if (trade && trade->has_fronts) {
    AtomicFile file(dir / "fronts.csv");
    write_fronts_csv(own, trade->scopes, machines, [&](std::string_view rows) { file.write(rows); });
    file.commit();
  }
  if (std::ranges::any_of(cells, [](const records::CellRecord& cell) { return cell.accumulation.has_value(); }))
    write_page(dir, "frames", make_frames_page(cells, run));
  else
    remove_page(dir, "frames");  // of another run into this folder
  write_grids(dir, shown, run.gl, width);
  write_page(dir, "run", make_run_page(run, shown, trade, machines, biases));
  records::write_results(dir, run, cells);
}

void write_early_report(const std::filesystem::path& dir, records::RunRecord run,
                        const std::vector<records::CellRecord>& cells, const std::string& so_far,
                        images::SheetWidth width) {
  add_warnings(run, cells);
  const auto withheld = analysis::withhold_mixed_times(cells);
  const std::vector<records::CellRecord>& shown = withheld ? *withheld : cells;
  write_grids(dir, shown, run.gl, width);
  write_early_page(dir, "run", make_run_page(run, shown, make_trade(shown), {}, {}, so_far));
}

}  // namespace shadowbench::pages
