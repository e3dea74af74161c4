#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "report/analysis/cell_group.h"
#include "report/analysis/summary.h"
#include "report/records/error_parts.h"

namespace shadowbench::analysis {

/// How far a cell's RMSE may be off: half the width of its 95 % interval over the phases of the map's grid, or the
/// truth's standard error where the run has one phase; 0 where neither is known.
double find_rmse_reach(const records::CellRecord& cell);

/// Ranks cells by their RMSE to the area truth, smallest first, as groups of indices into `cells` that are not ranked
/// apart. Of its class of width, a cell joins the group of the best cell from which it differs by no more than
/// find_rmse_reach(), the larger of the two; a cell of no class joins none. Cells without an RMSE are left out.
std::vector<std::vector<std::size_t>> rank_errors(const std::vector<records::CellRecord>& cells);

/// Finds the part that alone is more than half of an error, as an index into list_error_parts().
std::optional<std::size_t> find_dominating_part(const records::PartValues& shares);

/// Whether a cell's RMSE is at most the standard error of its truth; false where either is unknown.
bool is_lost_in_truth(const records::CellRecord& cell);

/// Says in plain sentences how wrong a group's cells are, where that comes from, and which faults show.
std::vector<std::string> describe_accuracy(const CellGroup& group);

}  // namespace shadowbench::analysis
