#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "report/pages/text_tables.h"
#include "report/records/records.h"

namespace shadowbench::pages {

/// Is one column of timings.csv.
struct CsvColumn {
  std::string name;
  std::string meaning;  ///< with its unit
};

/// Names the tables that a report has as CSV.
enum class CsvTable {
  kTimings,   ///< timings.csv: what each cell costs
  kAccuracy,  ///< accuracy.csv: how far each cell is from the truth
};

/// Lists the columns of a table, in order.
std::vector<CsvColumn> list_csv_columns(CsvTable table);

/// Makes a table: a header and one row per cell, each with every column; a value that does not exist is an empty field.
/// Numbers read back as the same doubles.
std::string make_csv(CsvTable table, const records::RunRecord& run, const std::vector<records::CellRecord>& cells);

/// Makes summary.md: what was run, per group of comparable cells a table and sentences from its numbers, what is absent
/// and why, and the meaning of the columns of the CSV files. `trade` is Markdown that goes before the groups.
std::string make_summary(const records::RunRecord& run, const std::vector<records::CellRecord>& cells,
                         const std::string& trade = {});

}  // namespace shadowbench::pages
