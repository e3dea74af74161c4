#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "report/records.h"
#include "report/text_tables.h"

namespace shadowbench::report {

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

/// Quotes a text as one CSV field, where it needs quoting.
/// Source: RFC 4180.
std::string quote_csv(std::string_view text);

/// Makes a table: a header and one row per cell, each with every column; a value that does not exist is an empty field.
/// Numbers read back as the same doubles.
std::string make_csv(CsvTable table, const RunRecord& run, const std::vector<CellRecord>& cells);

/// Escapes a text so that Markdown shows it as it is, also in a table's field.
std::string escape_markdown(std::string_view text);

/// Writes a table as Markdown.
std::string markdown_table(const TextTable& table);

/// Makes summary.md: what was run, per group of comparable cells a table and sentences from its numbers, what is absent
/// and why, and the meaning of the columns of the CSV files. `trade` is Markdown that goes before the groups.
std::string make_summary(const RunRecord& run, const std::vector<CellRecord>& cells, const std::string& trade = {});

}  // namespace shadowbench::report
