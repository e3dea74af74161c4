#include "harness/stress/heat_map.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <optional>

#include "report/images/color_values.h"
#include "report/images/figures/figure.h"

namespace shadowbench::stress {
namespace {

constexpr images::Size kPlot{880, 480};
constexpr int kLeft = 76;  // room for the ticks of y
constexpr int kTick = 6, kBar = 16, kBarWidth = 320;
constexpr int kPen = 3;  // width of the curve

/// Places a value between an axis' ends, [0,1].
double place(const HeatAxis& axis, double value) {
  return (value - axis.range.low) / (axis.range.high - axis.range.low);
}

class HeatMapDrawing {
 public:
  explicit HeatMapDrawing(const HeatMap& map)
      : map_(map),
        line_(images::figure_line_height()),
        figure_(map.title, map.note, {kLeft + kPlot.width + line_, kPlot.height + 6 * line_ + kTick + kBar}),
        plot_{figure_.body().x + kLeft, figure_.body().y + line_ + line_ / 2, kPlot.width, kPlot.height} {}

  images::Image draw() {
    place_values();
    draw_curve();
    draw_ticks();
    draw_legend(plot_.y + plot_.height + kTick + 2 * line_ + line_ / 2);
    return figure_.canvas();
  }

 private:
  const HeatMap& map_;
  int line_;
  images::Figure figure_;
  images::Rect plot_;

  int x_of(double value) const {
    return plot_.x + static_cast<int>(std::lround(place(map_.x, value) * (plot_.width - 1)));
  }
  int y_of(double value) const {
    return plot_.y + static_cast<int>(std::lround((1.0 - place(map_.y, value)) * (plot_.height - 1)));
  }

  void place_values() {
    const images::Image& values = map_.values;
    images::Image colors(plot_.width, plot_.height, 3);
    for (int y = 0; y < plot_.height; ++y) {
      for (int x = 0; x < plot_.width; ++x) {
        const float value = *values.at(x * values.width / plot_.width, y * values.height / plot_.height);
        std::ranges::copy(images::map_diverging(value, static_cast<float>(map_.scale)), colors.at(x, y));
      }
    }
    figure_.place(plot_.x, plot_.y, colors);
  }

  /// Every column is drawn from where the one before ended: steep parts stay in one piece.
  void draw_curve() {
    std::optional<int> before;
    for (int x = plot_.x; x < plot_.x + plot_.width; ++x) {
      const double share = static_cast<double>(x - plot_.x) / (plot_.width - 1);
      const double value = map_.curve(map_.x.range.low + share * (map_.x.range.high - map_.x.range.low));
      const bool inside = value <= map_.y.range.high;
      const int y = inside ? y_of(value) : plot_.y;
      const int top = std::min(y, before.value_or(y)), bottom = std::max(y, before.value_or(y));
      figure_.fill({x - kPen / 2, top - kPen / 2, kPen, bottom - top + kPen}, images::kFigureInk);
      if (!inside) return;
      before = y;
    }
  }

  void draw_ticks() {
    figure_.write(figure_.body().x, figure_.body().y, map_.y.label);
    for (const double tick : map_.y.ticks) {
      figure_.fill({plot_.x - kTick, y_of(tick), kTick, 1}, images::kFigureSecondInk);
      figure_.write_before(plot_.x - 2 * kTick, y_of(tick) - line_ / 2, fmt::format("{:g}", tick));
    }
    const int under = plot_.y + plot_.height;
    for (const double tick : map_.x.ticks) {
      figure_.fill({x_of(tick), under, 1, kTick}, images::kFigureSecondInk);
      figure_.write_centred(x_of(tick), under + kTick, fmt::format("{:g}", tick));
    }
    figure_.write_centred(plot_.x + plot_.width / 2, under + kTick + line_, map_.x.label);
  }

  void draw_legend(int top) {
    images::Image ramp(kBarWidth, kBar, 3);
    for (int y = 0; y < kBar; ++y)
      for (int x = 0; x < kBarWidth; ++x)
        std::ranges::copy(images::map_diverging(static_cast<float>(x) / (kBarWidth - 1), 1.0f), ramp.at(x, y));
    figure_.place(plot_.x, top, ramp);
    figure_.write(plot_.x + kBarWidth + line_, top + (kBar - line_) / 2, map_.quantity);
    figure_.write_centred(plot_.x, top + kBar, "0");
    figure_.write_centred(plot_.x + kBarWidth, top + kBar, fmt::format("{:g}", map_.scale));
    figure_.fill({plot_.x, top + kBar + line_ + line_ / 2, 3 * line_, kPen}, images::kFigureInk);
    figure_.write(plot_.x + 4 * line_, top + kBar + line_, "theory");
  }
};

}  // namespace

images::Image draw_heat_map(const HeatMap& map) {
  assert(map.values.channels == 1 && map.curve);
  return HeatMapDrawing(map).draw();
}

}  // namespace shadowbench::stress
