#pragma once

#include <cstddef>

#include "report/page/chart.h"

namespace shadowbench::page {

/// The colour of lines that belong to no filter.
inline constexpr const char* kInk = "#1c1f24";

/// How a filter is drawn in charts.
struct ChartStyle {
  const char* color;  ///< "#rrggbb", on white
  Mark mark;
};

/// The style of the filter at a place in list_filters(): colours that people of every colour vision tell apart,
/// and marks that change with them, so that 35 filters have styles of their own. Source of the colours: Okabe and Ito
/// 2008, Color Universal Design; without their yellow, which is faint on white.
ChartStyle style_of(std::size_t filter);

}  // namespace shadowbench::page
