#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "report/crossover.h"
#include "report/gnuplot.h"
#include "report/light_growth.h"
#include "report/trade.h"

namespace shadowbench::report {

/// Is the trade of a run: everything that is said and drawn of it.
struct Trade {
  std::vector<TradeScope> scopes;
  bool has_fronts = false;  ///< has_trade(); without it there is only what several lights cost
  std::vector<RadiusChart> charts;
  std::vector<LightChart> lights;
  std::vector<Plot> plots;              ///< for documents
  std::optional<std::string> no_plots;  ///< why the plots are not there
};

/// Finds the trade of a run's cells; nothing where has_trade() is false and no frame of several lights was timed.
/// Writes no file.
std::optional<Trade> make_trade(const RunRecord& run, const std::vector<CellRecord>& cells);

/// Writes the trade's files into a report folder: fronts.csv, chart.min.js, plots/plots.gp and, where gnuplot runs, the
/// plots; sets `no_plots` of what it returns where it does not.
/// Throws Error(kOutput).
Trade write_trade_files(const std::filesystem::path& dir, const std::vector<CellRecord>& cells, Trade trade);

/// Makes the section of index.html that shows the trade: plots that answer to the mouse, drawn by chart.min.js beside
/// the page, sentences, and links to the plots for documents. Sentences are there without scripts too.
std::string make_trade_html(const RunRecord& run, const std::vector<CellRecord>& cells, const Trade& trade);

/// Makes the section of summary.md: fronts of RMSE against both times, of each scope; crossovers, growth with sizes and
/// with lights, and the columns of fronts.csv.
std::string make_trade_markdown(const RunRecord& run, const std::vector<CellRecord>& cells, const Trade& trade);

}  // namespace shadowbench::report
