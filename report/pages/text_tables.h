#pragma once

#include <string>
#include <vector>

#include "report/analysis/cell_group.h"
#include "report/document/blocks.h"
#include "report/records/csv_tables.h"
#include "report/records/text_table.h"

namespace shadowbench::pages {

/// Makes the table of what a group's cells cost, for people, one row per cell, its times being those of `gl`.
records::TextTable make_cost_table(const analysis::CellGroup& group, const records::GlRecord& gl);

/// Makes the table of how wrong a group's cells are and why, for people, one row per cell.
records::TextTable make_accuracy_table(const analysis::CellGroup& group);

/// What the columns of a CSV file mean, for readers who unfold it.
document::Details explain_columns(const std::string& file, const std::vector<records::CsvColumn>& columns);

}  // namespace shadowbench::pages
