#pragma once

#include <string>
#include <vector>

#include "report/records/records.h"

namespace shadowbench::analysis {

/// The cells of one scene, view, map, bias and picture size: what one table and one grid compare.
struct CellGroup {
  std::string scene;
  std::vector<records::CellRecord> cells;
};

/// Groups cells by what may be compared, in the order in which each group first appears.
std::vector<CellGroup> group_cells(const std::vector<records::CellRecord>& cells);

/// Names a cell of a group: its filter, with its parameters where the group holds that filter more than once.
std::string label_cell(const CellGroup& group, const records::CellRecord& cell);

}  // namespace shadowbench::analysis
