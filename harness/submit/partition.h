#pragma once

#include <vector>

#include "harness/options/options.h"

namespace shadowbench::submit {

/// Splits cells into at most `tasks` stretches of about equal cost, none of them empty: a stretch costs at most its
/// share and one cell more. Neighbours in a plan share scene, view and map, so that a stretch sets up few of them.
/// Requires costs above 0, in any unit, and at least one task.
std::vector<options::CellRange> split_evenly(const std::vector<double>& costs, int tasks);

}  // namespace shadowbench::submit
