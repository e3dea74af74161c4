#pragma once

#include <string>
#include <vector>

#include "report/tables.h"
#include "report/trade.h"

namespace shadowbench::report {

/// Lists the columns of fronts.csv with their meanings.
std::vector<CsvColumn> list_front_columns();

/// Makes fronts.csv: a header and one row per scope, error, cost and cell. A scope of all scenes names a configuration
/// by the keys of its cells, joined by '+'. What a front leaves out has its reason and empty fields.
std::string make_fronts_csv(const std::vector<CellRecord>& cells, const std::vector<TradeScope>& scopes);

}  // namespace shadowbench::report
