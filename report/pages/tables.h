#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "report/pages/text_tables.h"
#include "report/records/csv_tables.h"
#include "report/records/records.h"

namespace shadowbench::pages {

using records::CsvColumn, records::CsvTable, records::list_csv_columns, records::make_csv;

/// Makes summary.md: what was run, per group of comparable cells a table and sentences from its numbers, what is absent
/// and why, and the meaning of the columns of the CSV files. `trade` is Markdown that goes before the groups.
std::string make_summary(const records::RunRecord& run, const std::vector<records::CellRecord>& cells,
                         const std::string& trade = {});

}  // namespace shadowbench::pages
