#pragma once

#include <cstddef>
#include <vector>

#include "report/records/records.h"

namespace shadowbench::analysis {

/// Ranks cells by their lookup, fastest first, as groups of indices into `cells` that are not ranked apart.
/// A cell joins the group of the fastest cell whose interval overlaps its own. The interval is the 95 % one of the
/// ratio to `none`; where a timed cell lacks it, all cells are ranked by their quartiles. Untimed cells are left out.
std::vector<std::vector<std::size_t>> rank_lookups(const std::vector<records::CellRecord>& cells);

}  // namespace shadowbench::analysis
