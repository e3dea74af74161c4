#pragma once

#include <cstddef>
#include <optional>

#include "report/records/error_parts.h"
#include "report/records/records.h"

namespace shadowbench::analysis {

/// How far a cell's RMSE may be off: half the width of its 95 % interval over the phases of the map's grid, or the
/// truth's standard error where the run has one phase; 0 where neither is known.
double find_rmse_reach(const records::CellRecord& cell);

/// Finds the part that alone is more than half of an error, as an index into list_error_parts().
std::optional<std::size_t> find_dominating_part(const records::PartShares& shares);

/// Whether a cell's RMSE is at most the standard error of its truth; false where either is unknown.
bool is_lost_in_truth(const records::CellRecord& cell);

}  // namespace shadowbench::analysis
