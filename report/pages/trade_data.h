#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "report/analysis/crossover.h"
#include "report/analysis/trade.h"

namespace shadowbench::pages {

/// Makes what trade_page.js draws from: measures, filters with their styles, scopes with configurations (values as
/// [value, low, high] or null), axes, pictures (URLs), and each front: standing and `by` of every configuration that
/// has both values, members cheapest first, and its sentences; and the charts of time over kernel radius with their
/// crossings.
nlohmann::json make_trade_data(const records::RunRecord& run, const std::vector<records::CellRecord>& cells,
                               const std::vector<analysis::TradeScope>& scopes,
                               const std::vector<analysis::RadiusChart>& charts);

/// Writes JSON for a script element: no text in it can end the element or begin a comment.
std::string dump_for_script(const nlohmann::json& data);

}  // namespace shadowbench::pages
