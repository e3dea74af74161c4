#include "report/pages/flicker_plots.h"

#include <fmt/format.h>

#include "report/page/plot_style.h"

namespace shadowbench::pages {
namespace {

constexpr std::size_t kStepsPerPoint = 8;

page::PlotSeries make_series(const std::string& title, const char* color, page::PlotLine line,
                             const std::vector<double>& changes) {
  page::PlotSeries series{title, color, 0, line, false, {}};
  for (std::size_t i = 0; i < changes.size(); ++i) {
    const double step = static_cast<double>(i + 1);
    series.points.push_back({{step, step, step}, {changes[i], changes[i], changes[i]}});
  }
  return series;
}

/// A filter's points, far apart, so that lines of one colour are told apart; the key shows them.
page::PlotSeries make_points(const records::FlickerFilter& filter, std::size_t place) {
  const page::PlotStyle style = page::style_of(place);
  page::PlotSeries series = make_series(filter.filter, style.color, page::PlotLine::kNone, filter.mean_change);
  series.point_type = style.hollow_point;
  std::vector<page::PlotPoint> chosen;
  for (std::size_t i = place % kStepsPerPoint; i < series.points.size(); i += kStepsPerPoint)
    chosen.push_back(std::move(series.points[i]));
  series.points = std::move(chosen);
  return series;
}

/// A linear scale from 0 for everything that moves here.
page::PlotAxis choose_change_axis(const records::FlickerMotion& motion) {
  std::vector<double> values = {0.0};
  values.insert(values.end(), motion.truth.mean_change.begin(), motion.truth.mean_change.end());
  for (const records::FlickerVariant& variant : motion.variants)
    for (const records::FlickerFilter& filter : variant.filters)
      values.insert(values.end(), filter.mean_change.begin(), filter.mean_change.end());
  return page::choose_axis(values, {}, page::TickKind::kNumber);
}

}  // namespace

std::string flicker_plot_file(const records::FlickerMotion& motion, const records::FlickerVariant& variant) {
  return fmt::format("flicker.{}{}.svg", motion.id, variant.snap ? ".snapped" : "");
}

page::Plot make_flicker_plot(const records::FlickerMotion& motion, const records::FlickerVariant& variant) {
  page::Plot plot;
  plot.file = flicker_plot_file(motion, variant);
  plot.title = fmt::format("{}, {} snapping", motion.title, variant.snap ? "with" : "without");
  plot.x_name = "step";
  plot.y_name = "mean |change| of visibility";
  plot.x = page::choose_axis({0.0, static_cast<double>(motion.truth.mean_change.size())}, {}, page::TickKind::kNumber);
  plot.y = choose_change_axis(motion);
  for (std::size_t i = 0; i < variant.filters.size(); ++i) {
    plot.series.push_back(
        make_series({}, page::style_of(i).color, page::PlotLine::kSolid, variant.filters[i].mean_change));
    plot.series.push_back(make_points(variant.filters[i], i));
  }
  plot.series.push_back(make_series("truth", page::kInk, page::PlotLine::kDashed, motion.truth.mean_change));
  return plot;
}

}  // namespace shadowbench::pages
