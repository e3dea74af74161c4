#pragma once

#include <string>
#include <vector>

#include "report/analysis/trade_measures.h"

namespace shadowbench::analysis {

/// How fronts are read: what dominated and tied mean, what the intervals are, how scenes are combined, and what each of
/// `costs` is.
std::vector<std::string> explain_fronts(const std::vector<Measure>& costs);

}  // namespace shadowbench::analysis
