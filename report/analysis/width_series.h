#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "report/analysis/trade.h"

namespace shadowbench::analysis {

/// The configurations of one filter that differ in nothing but the width of their kernel and the parameters that it
/// follows from: those whose value changes exactly with the width.
struct WidthSeries {
  std::string filter;
  std::string label;                        ///< with the parameters that tell it from the filter's other series
  std::vector<std::size_t> configurations;  ///< indices, narrow before wide
};

/// Sorts those of `configurations` that `chosen` holds into series, in the order in which each first appears. Each map
/// size has its own; configurations whose kernel's width is unknown are left out.
std::vector<WidthSeries> list_width_series(const std::vector<TradeConfiguration>& configurations,
                                           const std::vector<std::size_t>& chosen);

}  // namespace shadowbench::analysis
