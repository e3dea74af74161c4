#include "report/pages/trade_plots.h"

#include <fmt/format.h>

#include <algorithm>

#include "report/analysis/summary.h"
#include "report/page/plot_style.h"
#include "report/records/format.h"

namespace shadowbench::pages {
namespace {

page::PlotAxis choose_measure_axis(const std::vector<const analysis::Measured*>& measured, bool bytes) {
  std::vector<double> values, ends;
  for (const analysis::Measured* each : measured) {
    if (!each->estimate) continue;
    values.push_back(each->estimate->value);
    ends.push_back(each->estimate->low);
    ends.push_back(each->estimate->high);
  }
  return page::choose_axis(values, ends, bytes ? page::TickKind::kBytes : page::TickKind::kNumber);
}

std::size_t place_of(const std::vector<std::string>& filters, const std::string& filter) {
  return static_cast<std::size_t>(std::find(filters.begin(), filters.end(), filter) - filters.begin());
}

page::PlotPoint make_point(const analysis::TradeFront& front, std::size_t i) {
  return {front.points[i].cost, front.points[i].error};
}

// One filter's cells of one standing.
page::PlotSeries make_series(const analysis::TradeScope& scope, const analysis::TradeFront& front,
                             const std::string& filter, analysis::Standing standing) {
  page::PlotSeries series;
  for (std::size_t i = 0; i < front.points.size(); ++i) {
    if (scope.configurations[front.configurations[i]].filter != filter || front.placements[i].standing != standing)
      continue;
    series.points.push_back(make_point(front, i));
  }
  return series;
}

// The line through the members, with their numbers beside it.
page::PlotSeries make_front_line(const analysis::TradeFront& front) {
  page::PlotSeries line{"front", page::kInk, 0, page::PlotLine::kSteps, false, {}};
  for (const std::size_t member : front.members) {
    line.points.push_back(make_point(front, member));
    line.points.back().label = fmt::format("{}", line.points.size());
  }
  return line;
}

void add_filter(std::vector<page::PlotSeries>& series, const analysis::TradeScope& scope,
                const analysis::TradeFront& front, const std::string& filter, const page::PlotStyle& style) {
  const std::string color = style.color;
  const std::string faint = "#99" + color.substr(1);
  const std::tuple<analysis::Standing, int, std::string> looks[] = {
      {analysis::Standing::kDominated, style.hollow_point, faint},
      {analysis::Standing::kTied, style.hollow_point, color},
      {analysis::Standing::kFront, style.filled_point, color}};
  const std::size_t before = series.size();
  for (const auto& [standing, point_type, look] : looks) {
    page::PlotSeries one = make_series(scope, front, filter, standing);
    one.color = look;
    one.point_type = point_type;
    one.whiskers = true;
    if (!one.points.empty()) series.push_back(std::move(one));
  }
  if (series.size() > before) series.push_back({filter, color, style.filled_point, page::PlotLine::kNone, false, {}});
}

page::Plot make_front_plot(const analysis::TradeScope& scope, const analysis::TradeFront& front,
                           const std::vector<std::string>& filters, const records::GlRecord& gl) {
  const analysis::Measure &error = analysis::list_error_measures()[front.error],
                          &cost = analysis::list_cost_measures()[front.cost];
  page::Plot plot{fmt::format("plots/{}.{}.{}.svg", scope.id, error.id, cost.id),
                  scope.title,
                  analysis::name_axis(cost, gl),
                  analysis::name_axis(error, gl),
                  choose_cost_axis(scope, front.cost),
                  choose_error_axis(scope, front.error),
                  {make_front_line(front)},
                  {}};
  for (std::size_t i = 0; i < filters.size(); ++i) add_filter(plot.series, scope, front, filters[i], page::style_of(i));
  plot.series.push_back({"tied: hollow; dominated: faint", "#ffffff", 0, page::PlotLine::kNone, false, {}});
  for (std::size_t i = 0; i < front.members.size(); ++i) {
    plot.notes.push_back(
        fmt::format("{}: {}", i + 1, scope.configurations[front.configurations[front.members[i]]].label));
  }
  return plot;
}

const analysis::Estimate& time_of(const analysis::RadiusPoint& point, analysis::LightState light) {
  return light == analysis::LightState::kStill ? point.still : point.moving;
}

page::PlotSeries make_curve_series(const analysis::RadiusCurve& curve, analysis::LightState light,
                                   const page::PlotStyle& style) {
  page::PlotSeries series{curve.label,
                          style.color,
                          style.filled_point,
                          curve.prefiltered ? page::PlotLine::kSolid : page::PlotLine::kDashed,
                          true,
                          {}};
  for (const analysis::RadiusPoint& p : curve.points)
    series.points.push_back({{p.radius_texels, p.radius_texels, p.radius_texels}, time_of(p, light)});
  return series;
}

page::PlotSeries make_crossings(const analysis::RadiusChart& chart, analysis::LightState light) {
  page::PlotSeries series{"crossing", page::kInk, 2, page::PlotLine::kNone, false, {}};
  for (const analysis::CurveComparison& each : analysis::compare_curves(chart, light)) {
    for (const analysis::RadiusPoint& p : each.crossings) {
      series.points.push_back({{p.radius_texels, p.radius_texels, p.radius_texels},
                               time_of(p, light),
                               records::format_number(p.radius_texels)});
    }
  }
  if (series.points.empty()) series.title.clear();
  return series;
}

page::Plot make_radius_plot(const analysis::RadiusChart& chart, analysis::LightState light,
                            const std::vector<std::string>& filters, const records::GlRecord& gl) {
  const bool still = light == analysis::LightState::kStill;
  std::vector<double> radii, times, ends;
  page::Plot plot{
      fmt::format("plots/{}.map{}.radius.{}.svg", chart.scope_id, chart.map_size, still ? "still" : "moving"),
      chart.title,
      "kernel half-width, texels",
      analysis::name_axis(analysis::list_cost_measures()[still ? 0 : 1], gl),
      {},
      {},
      {},
      {}};
  for (const analysis::RadiusCurve& curve : chart.curves) {
    plot.series.push_back(make_curve_series(curve, light, page::style_of(place_of(filters, curve.filter))));
    for (const page::PlotPoint& point : plot.series.back().points) {
      radii.push_back(point.x.value);
      times.push_back(point.y.value);
      ends.push_back(point.y.low);
      ends.push_back(point.y.high);
    }
  }
  plot.series.push_back(make_crossings(chart, light));
  plot.x = page::choose_axis(radii, {}, page::TickKind::kNumber);
  plot.y = page::choose_log_axis(times, ends);
  plot.notes = {"solid: prefiltered", "dashed: read at every lookup"};
  return plot;
}

page::PlotSeries make_light_series(const analysis::LightCurve& curve, analysis::LightState light,
                                   const page::PlotStyle& style) {
  const bool still = light == analysis::LightState::kStill;
  page::PlotSeries series{still ? curve.label : "",
                          style.color,
                          still ? style.filled_point : style.hollow_point,
                          still ? page::PlotLine::kSolid : page::PlotLine::kDashed,
                          true,
                          {}};
  for (const analysis::LightPoint& p : curve.points) {
    const double count = p.count;
    series.points.push_back({{count, count, count}, analysis::frame_time(p, light)});
  }
  return series;
}

page::PlotAxis make_count_axis(const std::vector<int>& counts) {
  page::PlotAxis axis{true, counts.front() / 1.12, counts.back() * 1.12, {}};
  for (const int count : counts) axis.ticks.push_back({count, fmt::format("{}", count)});
  return axis;
}

// What grows in proportion, from the corner of the plot on.
page::PlotSeries make_proportion(const analysis::LightChart& chart, const page::PlotAxis& y) {
  const double from = chart.counts.front(), to = std::min<double>(chart.counts.back(), from * y.high / y.low);
  return {"in proportion",
          "#9aa0a8",
          0,
          page::PlotLine::kSolid,
          false,
          {{{from, from, from}, {y.low, y.low, y.low}}, {{to, to, to}, {y.low * to / from, y.low, y.low}}}};
}

page::Plot make_light_plot(const analysis::LightChart& chart, const std::vector<std::string>& filters,
                           const records::GlRecord& gl) {
  page::Plot plot{light_plot_file(chart),
                  chart.title,
                  "lights, each with a map of its own",
                  fmt::format("time of a frame, ms: {}", records::describe_clock(gl)),
                  make_count_axis(chart.counts),
                  {},
                  {},
                  {}};
  std::vector<double> times, ends;
  for (const analysis::LightCurve& curve : chart.curves) {
    for (const analysis::LightState light : {analysis::LightState::kStill, analysis::LightState::kMoving}) {
      plot.series.push_back(make_light_series(curve, light, page::style_of(place_of(filters, curve.filter))));
      for (const page::PlotPoint& point : plot.series.back().points) {
        times.push_back(point.y.value);
        ends.insert(ends.end(), {point.y.low, point.y.high});
      }
    }
  }
  plot.y = page::choose_log_axis(times, ends);
  plot.series.insert(plot.series.begin(), make_proportion(chart, plot.y));
  plot.notes = {"solid: casters still", "dashed: casters moving"};
  return plot;
}

}  // namespace

page::PlotAxis choose_error_axis(const analysis::TradeScope& scope, std::size_t error) {
  std::vector<const analysis::Measured*> measured;
  for (const analysis::TradeConfiguration& each : scope.configurations) measured.push_back(&each.errors[error]);
  return choose_measure_axis(measured, false);
}

page::PlotAxis choose_cost_axis(const analysis::TradeScope& scope, std::size_t cost) {
  std::vector<const analysis::Measured*> measured;
  for (const analysis::TradeConfiguration& each : scope.configurations) measured.push_back(&each.costs[cost]);
  return choose_measure_axis(measured, analysis::list_cost_measures()[cost].is_bytes);
}

std::vector<page::Plot> make_front_plots(const std::vector<analysis::TradeScope>& scopes,
                                         const std::vector<std::string>& filters, const records::GlRecord& gl) {
  const std::pair<std::size_t, std::size_t> pairs[] = {{0, 0}, {0, 1}, {0, 2}, {0, 3}, {2, 0}, {2, 1}};
  std::vector<page::Plot> plots;
  for (const analysis::TradeScope& scope : scopes) {
    for (const auto& [error, cost] : pairs) {
      const analysis::TradeFront front = analysis::make_trade_front(scope, error, cost);
      if (front.points.size() > 1) plots.push_back(make_front_plot(scope, front, filters, gl));
    }
  }
  return plots;
}

std::vector<page::Plot> make_radius_plots(const std::vector<analysis::RadiusChart>& charts,
                                          const std::vector<std::string>& filters, const records::GlRecord& gl) {
  std::vector<page::Plot> plots;
  for (const analysis::RadiusChart& chart : charts)
    for (const analysis::LightState light : {analysis::LightState::kStill, analysis::LightState::kMoving})
      plots.push_back(make_radius_plot(chart, light, filters, gl));
  return plots;
}

std::string light_plot_file(const analysis::LightChart& chart) {
  return fmt::format("plots/{}.map{}.lights.svg", chart.scope_id, chart.map_size);
}

std::vector<page::Plot> make_light_plots(const std::vector<analysis::LightChart>& charts,
                                         const std::vector<std::string>& filters, const records::GlRecord& gl) {
  std::vector<page::Plot> plots;
  for (const analysis::LightChart& chart : charts)
    if (chart.counts.size() > 1) plots.push_back(make_light_plot(chart, filters, gl));
  return plots;
}

}  // namespace shadowbench::pages
