#include "harness/stress/heat_map.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <optional>

#include "report/images/color_values.h"

namespace shadowbench::stress {
namespace {

using images::Image;

constexpr images::Size kPlot{880, 480};
constexpr int kPen = 3;  // width of the curve
constexpr images::Rgb kInk{0.11f, 0.12f, 0.14f};

/// Places a value between an axis' ends, [0,1].
double place(const HeatAxis& axis, double value) {
  return (value - axis.range.low) / (axis.range.high - axis.range.low);
}

std::vector<images::Tick> list_ticks(const HeatAxis& axis) {
  std::vector<images::Tick> ticks;
  for (const double tick : axis.ticks) ticks.push_back({place(axis, tick), fmt::format("{:g}", tick)});
  return ticks;
}

Image draw_values(const Image& values, const images::ColorScale& scale) {
  Image plot(kPlot.width, kPlot.height, 3);
  for (int y = 0; y < plot.height; ++y)
    for (int x = 0; x < plot.width; ++x)
      std::ranges::copy(scale(*values.at(x * values.width / plot.width, y * values.height / plot.height)),
                        plot.at(x, y));
  return plot;
}

/// Every column is drawn from where the one before ended: steep parts stay in one piece.
void draw_curve(Image& plot, const HeatMap& map) {
  std::optional<int> before;
  for (int x = 0; x < plot.width; ++x) {
    const double share = static_cast<double>(x) / (plot.width - 1);
    const double value = map.curve(map.x.range.low + share * (map.x.range.high - map.x.range.low));
    const bool inside = value <= map.y.range.high;
    const int y = inside ? static_cast<int>(std::lround((1.0 - place(map.y, value)) * (plot.height - 1))) : 0;
    const int top = std::min(y, before.value_or(y)), bottom = std::max(y, before.value_or(y));
    images::fill_rect(plot, {x - kPen / 2, top - kPen / 2, kPen, bottom - top + kPen}, kInk);
    if (!inside) return;
    before = y;
  }
}

}  // namespace

images::Figure make_figure(const HeatMap& map) {
  assert(map.values.channels == 1 && map.curve);
  const images::ColorScale scale =
      images::make_linear_scale(0.0, map.scale, 1, [](float at) { return images::map_diverging(at, 1.0f); });
  Image plot = draw_values(map.values, scale);
  draw_curve(plot, map);
  return {map.title,
          map.note,
          {{{"", "up: " + map.y.label, std::move(plot), list_ticks(map.x), list_ticks(map.y)},
            {"", "to the right: " + map.x.label + "; black line: theory"},
            images::make_color_bar(scale, map.quantity)}}};
}

}  // namespace shadowbench::stress
