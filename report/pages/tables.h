#pragma once

#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "report/analysis/cells.h"
#include "report/analysis/trade.h"
#include "report/document/blocks.h"
#include "report/records/csv_tables.h"
#include "report/records/gpu_times.h"
#include "report/records/text_table.h"

namespace shadowbench::pages {

/// Makes the table of what a group's cells cost, for people, one row per cell, its times being those of `gl`.
records::TextTable make_cost_table(const analysis::CellGroup& group, const records::GlRecord& gl);

/// Makes the table of how wrong a group's cells are and why, for people, one row per cell.
records::TextTable make_accuracy_table(const analysis::CellGroup& group);

/// What the columns of a CSV file mean, for readers who unfold it.
void explain_columns(document::Details& details, const std::string& file,
                     const std::vector<records::CsvColumn>& columns);

/// Lists the columns of fronts.csv with their meanings.
std::vector<records::CsvColumn> list_front_columns();

/// Writes fronts.csv, front by front: a header and one row per scope, error, cost and cell. A scope of all scenes names
/// a configuration by the keys of its cells, joined by '+'. What a front leaves out has its reason and empty fields.
/// The times of `machines`, of the same cells, follow those of the run.
void write_fronts_csv(const std::vector<records::CellRecord>& cells, const std::vector<analysis::TradeScope>& scopes,
                      const std::vector<records::GpuTimes>& machines,
                      const std::function<void(std::string_view)>& write);

/// Errors and faults by cascade, and where cascades end in the terms of engines: a table and a chart for each scene and
/// fit. Nothing where no cell has cascades.
std::optional<document::Section> make_cascade_section(const std::vector<records::CellRecord>& cells);

/// What other renderers drew, held against the run's filters; nothing where the run has no such rows.
std::optional<document::Section> make_external_section(const std::vector<records::CellRecord>& cells);

/// What drew a row: "three.js r187 · map 1024 · bias -0.005"; empty where its user said nothing.
std::string describe_engine(const records::ExternalRecord& external);

}  // namespace shadowbench::pages
