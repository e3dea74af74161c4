#pragma once

#include <string>
#include <vector>

#include "report/analysis/trade.h"
#include "report/records/csv_tables.h"

namespace shadowbench::pages {

/// Lists the columns of fronts.csv with their meanings.
std::vector<records::CsvColumn> list_front_columns();

/// Makes fronts.csv: a header and one row per scope, error, cost and cell. A scope of all scenes names a configuration
/// by the keys of its cells, joined by '+'. What a front leaves out has its reason and empty fields.
std::string make_fronts_csv(const std::vector<records::CellRecord>& cells,
                            const std::vector<analysis::TradeScope>& scopes);

}  // namespace shadowbench::pages
