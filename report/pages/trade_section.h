#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "report/analysis/crossover.h"
#include "report/analysis/light_growth.h"
#include "report/analysis/trade.h"
#include "report/page/gnuplot.h"

namespace shadowbench::pages {

/// Is the trade of a run: everything that is said and drawn of it.
struct Trade {
  std::vector<analysis::TradeScope> scopes;
  bool has_fronts = false;  ///< has_trade(); without it there is only what several lights cost
  std::vector<analysis::RadiusChart> charts;
  std::vector<analysis::LightChart> lights;
  std::vector<page::Plot> plots;        ///< for documents
  std::optional<std::string> no_plots;  ///< why the plots are not there
};

/// Finds the trade of a run's cells; nothing where has_trade() is false and no frame of several lights was timed.
/// Writes no file.
std::optional<Trade> make_trade(const records::RunRecord& run, const std::vector<records::CellRecord>& cells);

/// Writes the trade's files into a report folder: fronts.csv, chart.min.js, plots/plots.gp and, where gnuplot runs, the
/// plots; sets `no_plots` of what it returns where it does not.
/// Throws Error(kOutput).
Trade write_trade_files(const std::filesystem::path& dir, const std::vector<records::CellRecord>& cells, Trade trade);

/// Makes the section of index.html that shows the trade: plots that answer to the mouse, drawn by chart.min.js beside
/// the page, sentences, and links to the plots for documents. Sentences are there without scripts too.
std::string make_trade_html(const records::RunRecord& run, const std::vector<records::CellRecord>& cells,
                            const Trade& trade);

/// Makes the section of summary.md: fronts of RMSE against both times, of each scope; crossovers, growth with sizes and
/// with lights, and the columns of fronts.csv.
std::string make_trade_markdown(const records::RunRecord& run, const std::vector<records::CellRecord>& cells,
                                const Trade& trade);

}  // namespace shadowbench::pages
