#pragma once

#include <cstddef>

#include "report/page/chart.h"

namespace shadowbench::page {

/// The colour of axes and texts of plots.
inline constexpr const char* kInk = "#1c1f24";

/// Is how a filter is drawn in plots.
struct PlotStyle {
  const char* color;  ///< "#rrggbb", on white
  const char* shape;  ///< "circle", "rect", "triangle", "rectRot" (a diamond), as Chart.js has them, or "down", a
                      ///< triangle on its tip
  int hollow_point;   ///< gnuplot's point type of that shape
  int filled_point;
  Mark mark;
};

/// Gives the style of the filter at a place in list_filters(): colours that people of every colour vision tell apart,
/// and shapes that change with them, so that 35 filters have styles of their own. Source of the colours: Okabe and Ito
/// 2008, Color Universal Design; without their yellow, which is faint on white.
PlotStyle style_of(std::size_t filter);

}  // namespace shadowbench::page
