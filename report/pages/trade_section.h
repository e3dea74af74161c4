#pragma once

#include <optional>
#include <vector>

#include "report/analysis/cost_curves.h"
#include "report/analysis/trade.h"
#include "report/document/blocks.h"

namespace shadowbench::pages {

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
