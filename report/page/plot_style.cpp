#include "report/page/plot_style.h"

#include <array>

namespace shadowbench::page {

PlotStyle style_of(std::size_t filter) {
  static constexpr std::array<const char*, 7> kColors = {"#000000", "#0072b2", "#d55e00", "#009e73",
                                                         "#cc79a7", "#e69f00", "#56b4e9"};
  static constexpr std::array<PlotStyle, 5> kShapes = {{{nullptr, "circle", 6, 7, Mark::kCircle},
                                                        {nullptr, "rect", 4, 5, Mark::kSquare},
                                                        {nullptr, "triangle", 8, 9, Mark::kTriangle},
                                                        {nullptr, "rectRot", 12, 13, Mark::kDiamond},
                                                        {nullptr, "down", 10, 11, Mark::kTriangleDown}}};
  PlotStyle style = kShapes[filter % kShapes.size()];
  style.color = kColors[filter % kColors.size()];
  return style;
}

}  // namespace shadowbench::page
