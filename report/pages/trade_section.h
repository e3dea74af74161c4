#pragma once

#include <optional>
#include <vector>

#include "report/document/blocks.h"
#include "report/records/records.h"

namespace shadowbench::pages {

/// A run of more cells than this has a page without what nobody could look through: the tables and bars of every scene
/// and map, and what is beaten in the charts of fronts. The CSV files have all of it.
inline constexpr std::size_t kMostCellsInDetail = 2000;

/// Makes the section that shows the trade: fronts of every scope, error and cost, a frame's cost over the kernel width,
/// and RMSE over bytes for the maps of several fits. `cells` are those that may be compared. On a front, members are
/// filled and joined; tied cells are hollow, beaten ones hollow and faint; these are left out of a run of more than
/// kMostCellsInDetail cells. Nothing where has_trade() is false, and no filter has maps of several fits.
std::optional<document::Section> make_trade_section(const records::RunRecord& run,
                                                    const std::vector<records::CellRecord>& cells);

}  // namespace shadowbench::pages
