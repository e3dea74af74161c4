#pragma once

#include <optional>
#include <vector>

#include "report/page/blocks.h"
#include "report/pages/trade_section.h"
#include "report/records/records.h"

namespace shadowbench::pages {

/// Makes the page of a run: its facts, warnings, the trade, per group of comparable cells its sentences, tables, bars
/// of the error's parts and pictures, what is absent and why, and what the columns of the CSV files mean.
page::Page make_run_page(const records::RunRecord& run, const std::vector<records::CellRecord>& cells,
                         const std::optional<Trade>& trade);

}  // namespace shadowbench::pages
