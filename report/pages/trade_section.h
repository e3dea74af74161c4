#pragma once

#include <optional>
#include <string>
#include <vector>

#include "report/analysis/trade.h"
#include "report/document/blocks.h"
#include "report/document/chart.h"

namespace shadowbench::pages {

/// A run of more cells than this has a page without what nobody could look through: the tables and bars of every scene
/// and map, and what is beaten in the charts of fronts. The CSV files have all of it.
inline constexpr std::size_t kMostCellsInDetail = 2000;

/// Draws the fronts of every scope, error and cost. Members are filled and joined; tied cells are hollow, dominated
/// ones hollow and faint; these are left out of a run of more than kMostCellsInDetail cells.
document::ChartChoice make_front_choice(const std::vector<analysis::TradeScope>& scopes,
                                        const std::vector<records::CellRecord>& cells, const records::GlRecord& gl);

/// Draws a frame's cost over the kernel width, for every chart and state of the light.
document::ChartChoice make_width_choice(const std::vector<analysis::CostChart>& charts,
                                        const std::vector<std::string>& filters, const records::GlRecord& gl);

/// Draws RMSE over bytes for the maps of every family, a curve for each fit; their cost, which make_map_measure()
/// measures, is told beside.
document::ChartChoice make_map_choice(const std::vector<analysis::MapFamily>& families, const analysis::Quantity& cost,
                                      const records::GlRecord& gl);

/// The trade of a run: everything that is said and drawn of it.
struct Trade {
  std::vector<analysis::TradeScope> scopes;
  bool has_fronts = false;  ///< has_trade(); without it there is only what maps cost
  std::vector<analysis::CostChart> width_charts;
  std::vector<analysis::MapFamily> map_families;
};

/// Finds the trade of a run's cells; nothing where has_trade() is false, and no filter has maps of several fits.
std::optional<Trade> make_trade(const std::vector<records::CellRecord>& cells);

/// Makes the section that shows the trade: fronts, and charts of cost over width and maps. `cells` are those
/// that may be compared.
document::Section make_trade_section(const records::RunRecord& run, const std::vector<records::CellRecord>& cells,
                                     const Trade& trade);

}  // namespace shadowbench::pages
