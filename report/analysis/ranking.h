#pragma once

#include <cstddef>
#include <vector>

#include "report/records/records.h"

namespace shadowbench::analysis {

/// Ranks cells by what they cost a frame with a moving light, cheapest first, as groups of indices into `cells` that
/// are not ranked apart. A cell joins the group of the cheapest cell whose interval overlaps its own; see
/// frame_interval(). Where a timed cell has no interval, all cells are ranked by their quartiles. Untimed cells are
/// left out.
std::vector<std::vector<std::size_t>> rank_costs(const std::vector<records::CellRecord>& cells);

}  // namespace shadowbench::analysis
