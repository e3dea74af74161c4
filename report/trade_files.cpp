#include <unistd.h>

#include <fmt/format.h>

#include "filters/error.h"
#include "report/atomic_file.h"
#include "report/embedded.h"
#include "report/trade_section.h"
#include "report/trade_table.h"

namespace shadowbench::report {
namespace {

namespace fs = std::filesystem;

// A folder beside the plots' place, so that they can be renamed into it; gone at the end.
class WorkFolder {
 public:
  explicit WorkFolder(const fs::path& dir) : path_(dir / fmt::format(".plots-{}", getpid())) {
    fs::create_directories(path_ / "plots");
  }
  ~WorkFolder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  WorkFolder(const WorkFolder&) = delete;
  WorkFolder& operator=(const WorkFolder&) = delete;

  const fs::path& path() const { return path_; }

 private:
  fs::path path_;
};

// Plots are a help for documents: whatever keeps them from being drawn is said, and stops nothing.
std::optional<std::string> draw_plots(const fs::path& dir, const std::vector<Plot>& plots, const std::string& script) {
  try {
    const WorkFolder work(dir);
    write_text_file(work.path() / "plots" / "plots.gp", script);
    if (const auto reason = run_gnuplot(work.path(), fs::path("plots") / "plots.gp")) return reason;
    for (const Plot& plot : plots) fs::rename(work.path() / plot.file, dir / plot.file);
    return std::nullopt;
  } catch (const std::exception& problem) {
    return fmt::format("they could not be written ({})", problem.what());
  }
}

}  // namespace

Trade write_trade_files(const fs::path& dir, const std::vector<CellRecord>& cells, Trade trade) {
  if (trade.has_fronts) {
    write_text_file(dir / "fronts.csv", make_fronts_csv(cells, trade.scopes));
    write_text_file(dir / "chart.min.js", chart_library());
  }
  const std::string script = make_gnuplot_script(trade.plots);
  write_text_file(dir / "plots" / "plots.gp", script);
  trade.no_plots = draw_plots(dir, trade.plots, script);
  return trade;
}

}  // namespace shadowbench::report
