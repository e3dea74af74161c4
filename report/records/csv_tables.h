#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "report/records/records.h"

namespace shadowbench::records {

/// A table's texts.
struct TextTable {
  std::vector<std::string> header;
  std::vector<std::vector<std::string>> rows;  ///< each as long as the header
};

/// Quotes a text as one CSV field, where it needs quoting. A text that a spreadsheet would run as a formula gets an
/// apostrophe in front; numbers stay as they are.
/// Source: RFC 4180.
std::string quote_csv(std::string_view text);

/// Writes a row, each field as it is quoted, with its end.
std::string make_csv_row(std::vector<std::string> fields);

/// Writes a table, each field as it is quoted. Source: RFC 4180.
std::string make_csv(const TextTable& table);

/// A column of a CSV table.
struct CsvColumn {
  std::string name;
  std::string meaning;  ///< with its unit
};

/// Names the tables that a report has as CSV.
enum class CsvTable {
  kTimings,   ///< timings.csv: what each cell costs
  kAccuracy,  ///< accuracy.csv: how far each cell is from the truth
};

/// Lists the columns of a table, in order: the cell's settings, its times or none, and the metrics of its groups.
std::vector<CsvColumn> list_csv_columns(CsvTable table);

/// Makes a table: a header and one row per cell, each with every column; a value that does not exist is an empty field.
/// Numbers read back as the same doubles.
std::string make_csv(CsvTable table, const RunRecord& run, const std::vector<CellRecord>& cells);

}  // namespace shadowbench::records
