#pragma once

#include <functional>
#include <string_view>
#include <vector>

#include "report/analysis/trade.h"
#include "report/records/csv_tables.h"
#include "report/records/gpu_times.h"

namespace shadowbench::pages {

/// Lists the columns of fronts.csv with their meanings.
std::vector<records::CsvColumn> list_front_columns();

/// Writes fronts.csv, front by front: a header and one row per scope, error, cost and cell. A scope of all scenes names
/// a configuration by the keys of its cells, joined by '+'. What a front leaves out has its reason and empty fields.
/// The times of `machines`, of the same cells, follow those of the run.
void write_fronts_csv(const std::vector<records::CellRecord>& cells, const std::vector<analysis::TradeScope>& scopes,
                      const std::vector<records::GpuTimes>& machines,
                      const std::function<void(std::string_view)>& write);

}  // namespace shadowbench::pages
