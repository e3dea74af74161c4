#pragma once

#include <string>
#include <vector>

#include "report/records/records.h"

namespace shadowbench::analysis {

/// Says how small a difference between two filters' RMSEs a run can tell apart, with 95 % confidence and a power of
/// 80 %: of one class of width, in one place. Empty where no two cells have phases in common.
std::string describe_power(const std::vector<records::CellRecord>& cells);

}  // namespace shadowbench::analysis
