#pragma once

#include <string>
#include <vector>

#include "report/analysis/trade.h"

namespace shadowbench::analysis {

/// Says in plain sentences what a front holds: the members of each class of width from cheapest to most exact with
/// numbers and intervals, what is tied with them, what they dominate, and what was left out and why; where many are
/// tied or dominated, they are counted by filter. Times are those of `gl`.
std::vector<std::string> describe_front(const TradeScope& scope, const TradeFront& front, const records::GlRecord& gl);

/// How fronts are read: what dominated and tied mean, what the intervals are, how scenes are combined.
std::vector<std::string> explain_fronts();

}  // namespace shadowbench::analysis
