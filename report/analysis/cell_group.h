#pragma once

#include <optional>
#include <string>
#include <string_view>
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

/// The class of a cell's kernel, an index into filters::width_classes(); empty where it has none.
std::optional<std::size_t> find_class(const records::CellRecord& cell);

/// The name of a class; empty without one.
std::string_view name_class(std::optional<std::size_t> width_class);

/// Names a cell of a group: its filter, with its parameters where the group holds that filter more than once.
std::string label_cell(const CellGroup& group, const records::CellRecord& cell);

}  // namespace shadowbench::analysis
