#pragma once

#include <string>

#include "report/analysis/cell_group.h"
#include "report/analysis/summary.h"

namespace shadowbench::pages {

/// Draws a group's errors as stacked bars on one scale, each an inline SVG with its numbers as text beside it; one line
/// for each cell with an error, which says why where it has no attribution. Empty where no cell has an attribution.
std::string make_bars_html(const analysis::CellGroup& group);

}  // namespace shadowbench::pages
