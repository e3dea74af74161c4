#pragma once

#include <string>
#include <vector>

#include "report/analysis/cell_group.h"

namespace shadowbench::analysis {

/// Says in a sentence for each trouble what breaks in a group's cells: broken texels, with the exponent that would be
/// safe, variances below 0, a bound that does not hold, a 16-bit store that shows. Nothing where nothing breaks, or
/// where the run was made without stability maps.
std::vector<std::string> describe_stability(const CellGroup& group);

/// Write the captions of the parts of a cell's stability picture; empty where there is nothing to say.
std::string caption_texels(const records::CellRecord& cell);
std::string caption_variance(const records::CellRecord& cell);
std::string caption_difference(const records::CellRecord& cell);
std::string caption_bound(const records::CellRecord& cell);

}  // namespace shadowbench::analysis
