#pragma once

#include <optional>
#include <string>
#include <vector>

#include "report/analysis/cells.h"
#include "report/document/blocks.h"
#include "report/records/csv_tables.h"

namespace shadowbench::pages {

/// Makes the table of what a group's cells cost, for people, one row per cell, its times being those of `gl`.
records::TextTable make_cost_table(const analysis::CellGroup& group, const records::GlRecord& gl);

/// Makes the table of how wrong a group's cells are and why, for people, one row per cell.
records::TextTable make_accuracy_table(const analysis::CellGroup& group);

/// What the columns of a CSV file mean, for readers who unfold it.
void explain_columns(document::Details& details, const std::string& file,
                     const std::vector<records::CsvColumn>& columns);

/// Errors and faults by cascade, and where cascades end: tables and a chart for each scene and fit. Nothing where no
/// cell has cascades.
std::optional<document::Section> make_cascade_section(const std::vector<records::CellRecord>& cells);

/// What other renderers drew, held against the run's filters; nothing where the run has no such rows.
std::optional<document::Section> make_external_section(const std::vector<records::CellRecord>& cells);

/// What drew a row: "three.js r187 · map 1024 · bias -0.005"; empty where its user said nothing.
std::string describe_engine(const records::ExternalRecord& external);

}  // namespace shadowbench::pages
