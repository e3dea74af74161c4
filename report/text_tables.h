#pragma once

#include <string>
#include <vector>

#include "report/summary.h"

namespace shadowbench::report {

/// Holds a table's texts.
struct TextTable {
  std::vector<std::string> header;
  std::vector<std::vector<std::string>> rows;  ///< each as long as the header
};

/// Makes the table of what a group's cells cost, for people, one row per cell, its times being those of `gl`.
TextTable make_cost_table(const CellGroup& group, const GlRecord& gl);

/// Makes the table of how wrong a group's cells are and why, for people, one row per cell.
TextTable make_accuracy_table(const CellGroup& group);

}  // namespace shadowbench::report
