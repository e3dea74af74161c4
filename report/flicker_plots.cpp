#include "report/flicker_plots.h"

#include <fmt/format.h>

#include "report/plot_style.h"

namespace shadowbench::report {
namespace {

constexpr const char* kInk = "#1c1f24";
constexpr std::size_t kStepsPerPoint = 8;

PlotSeries make_series(const std::string& title, const char* color, PlotLine line, const std::vector<double>& changes) {
  PlotSeries series{title, color, 0, line, false, {}};
  for (std::size_t i = 0; i < changes.size(); ++i) {
    const double step = static_cast<double>(i + 1);
    series.points.push_back({{step, step, step}, {changes[i], changes[i], changes[i]}});
  }
  return series;
}

/// A filter's points, far apart, so that lines of one colour are told apart; the key shows them.
PlotSeries make_points(const FlickerFilter& filter, std::size_t place) {
  const PlotStyle style = style_of(place);
  PlotSeries series = make_series(filter.filter, style.color, PlotLine::kNone, filter.mean_change);
  series.point_type = style.hollow_point;
  std::vector<PlotPoint> chosen;
  for (std::size_t i = place % kStepsPerPoint; i < series.points.size(); i += kStepsPerPoint)
    chosen.push_back(std::move(series.points[i]));
  series.points = std::move(chosen);
  return series;
}

/// A linear scale from 0 for everything that moves here.
PlotAxis choose_change_axis(const FlickerMotion& motion) {
  std::vector<double> values = {0.0};
  values.insert(values.end(), motion.truth.mean_change.begin(), motion.truth.mean_change.end());
  for (const FlickerVariant& variant : motion.variants)
    for (const FlickerFilter& filter : variant.filters)
      values.insert(values.end(), filter.mean_change.begin(), filter.mean_change.end());
  return choose_axis(values, {}, TickKind::kNumber);
}

}  // namespace

std::string flicker_plot_file(const FlickerMotion& motion, const FlickerVariant& variant) {
  return fmt::format("flicker.{}{}.svg", motion.id, variant.snap ? ".snapped" : "");
}

Plot make_flicker_plot(const FlickerMotion& motion, const FlickerVariant& variant) {
  Plot plot;
  plot.file = flicker_plot_file(motion, variant);
  plot.title = fmt::format("{}, {} snapping", motion.title, variant.snap ? "with" : "without");
  plot.x_name = "step";
  plot.y_name = "mean |change| of visibility";
  plot.x = choose_axis({0.0, static_cast<double>(motion.truth.mean_change.size())}, {}, TickKind::kNumber);
  plot.y = choose_change_axis(motion);
  for (std::size_t i = 0; i < variant.filters.size(); ++i) {
    plot.series.push_back(make_series({}, style_of(i).color, PlotLine::kSolid, variant.filters[i].mean_change));
    plot.series.push_back(make_points(variant.filters[i], i));
  }
  plot.series.push_back(make_series("truth", kInk, PlotLine::kDashed, motion.truth.mean_change));
  return plot;
}

}  // namespace shadowbench::report
