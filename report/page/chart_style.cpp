#include "report/page/chart_style.h"

#include <array>

namespace shadowbench::page {

ChartStyle style_of(std::size_t filter) {
  static constexpr std::array kColors = {"#000000", "#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9"};
  static constexpr std::array kMarks = {Mark::kCircle, Mark::kSquare, Mark::kTriangle, Mark::kDiamond,
                                        Mark::kTriangleDown};
  return {kColors[filter % kColors.size()], kMarks[filter % kMarks.size()]};
}

}  // namespace shadowbench::page
