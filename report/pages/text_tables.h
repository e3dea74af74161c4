#pragma once

#include <string>
#include <vector>

#include "report/analysis/cell_group.h"
#include "report/analysis/summary.h"
#include "report/records/text_table.h"

namespace shadowbench::pages {

/// Makes the table of what a group's cells cost, for people, one row per cell, its times being those of `gl`.
records::TextTable make_cost_table(const analysis::CellGroup& group, const records::GlRecord& gl);

/// Makes the table of how wrong a group's cells are and why, for people, one row per cell.
records::TextTable make_accuracy_table(const analysis::CellGroup& group);

}  // namespace shadowbench::pages
