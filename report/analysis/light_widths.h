#pragma once

#include <string>
#include <vector>

#include "report/records/records.h"

namespace shadowbench::analysis {

/// Says what the lights of a run's scenes asked of the kernels whose width they chose: the width in each map, the
/// kernels that cannot be nearly so wide, and those that are worse than no filter all the same, each with the largest
/// part of its error. Empty where no light chose one.
std::vector<std::string> describe_light_widths(const std::vector<records::CellRecord>& cells);

}  // namespace shadowbench::analysis
