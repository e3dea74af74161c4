#include "report/files/atomic_file.h"
#include "report/page/embedded.h"
#include "report/page/plot_files.h"
#include "report/pages/trade_section.h"
#include "report/pages/trade_table.h"

namespace shadowbench::pages {

Trade write_trade_files(const std::filesystem::path& dir, const std::vector<records::CellRecord>& cells, Trade trade) {
  if (trade.has_fronts) {
    files::write_text_file(dir / "fronts.csv", make_fronts_csv(cells, trade.scopes));
    files::write_text_file(dir / "chart.min.js", page::chart_library());
  }
  trade.no_plots = page::write_plot_files(dir, std::filesystem::path("plots") / "plots.gp", trade.plots);
  return trade;
}

}  // namespace shadowbench::pages
