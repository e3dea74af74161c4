#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "report/page/blocks.h"
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

/// Says what the columns of a file mean, for readers who unfold it.
page::Details explain_columns(const std::string& file, const std::vector<CsvColumn>& columns);

}  // namespace shadowbench::pages
