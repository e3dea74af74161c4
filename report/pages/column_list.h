#pragma once

#include <string>
#include <vector>

#include "report/page/blocks.h"
#include "report/records/csv_tables.h"

namespace shadowbench::pages {

/// What the columns of a CSV file mean, for readers who unfold it.
page::Details explain_columns(const std::string& file, const std::vector<records::CsvColumn>& columns);

}  // namespace shadowbench::pages
