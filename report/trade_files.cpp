#include "report/atomic_file.h"
#include "report/embedded.h"
#include "report/plot_files.h"
#include "report/trade_section.h"
#include "report/trade_table.h"

namespace shadowbench::report {

Trade write_trade_files(const std::filesystem::path& dir, const std::vector<CellRecord>& cells, Trade trade) {
  if (trade.has_fronts) {
    write_text_file(dir / "fronts.csv", make_fronts_csv(cells, trade.scopes));
    write_text_file(dir / "chart.min.js", chart_library());
  }
  trade.no_plots = write_plot_files(dir, std::filesystem::path("plots") / "plots.gp", trade.plots);
  return trade;
}

}  // namespace shadowbench::report
