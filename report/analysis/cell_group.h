#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "report/analysis/front.h"
#include "report/records/cell_names.h"
#include "report/records/error_parts.h"
#include "report/records/records.h"

namespace shadowbench::analysis {

/// The cells of one scene, view, map, bias and picture size: what one table and one grid compare.
struct CellGroup {
  std::string scene;
  std::vector<records::CellRecord> cells;
  records::CellNames names = records::CellNames({});  ///< of the cells
};

/// Groups cells by what may be compared, in the order in which each group first appears.
std::vector<CellGroup> group_cells(const std::vector<records::CellRecord>& cells);

/// A copy of the cells without those that other renderers drew, which have no cost here, and are in no trade. Nothing
/// where there are none.
std::optional<std::vector<records::CellRecord>> leave_out_external(const std::vector<records::CellRecord>& cells);

/// Whether several kinds of machine measured the cells, so that their times do not compare.
bool mixes_machines(const std::vector<records::CellRecord>& cells);

/// A copy of the cells without times where mixes_machines(); `absent` says why. Nothing where one kind measured them.
std::optional<std::vector<records::CellRecord>> withhold_mixed_times(const std::vector<records::CellRecord>& cells);

/// The class of a cell's kernel, an index into filters::list_width_names(); empty where it has none.
std::optional<std::size_t> find_class(const records::CellRecord& cell);

/// The name of a class; empty without one.
std::string name_class(std::optional<std::size_t> width_class);

/// How far a cell's RMSE may be off: half the width of its 95 % interval over the phases of the map's grid, or the
/// truth's standard error where the run has one phase; 0 where neither is known.
double find_rmse_reach(const records::CellRecord& cell);

/// A cell's RMSE with that reach and its groups of phases. Requires one.
Estimate estimate_rmse(const records::CellRecord& cell);

/// Finds the part that alone is more than half of an error, as an index into list_error_parts().
std::optional<std::size_t> find_dominating_part(const records::PartShares& shares);

/// Whether a cell's RMSE is at most the standard error of its truth; false where either is unknown.
bool is_lost_in_truth(const records::CellRecord& cell);

}  // namespace shadowbench::analysis
