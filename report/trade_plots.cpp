#include "report/trade_plots.h"

#include <fmt/format.h>

#include <algorithm>

#include "report/plot_style.h"
#include "report/summary.h"

namespace shadowbench::report {
namespace {

constexpr const char* kInk = "#1c1f24";

PlotAxis choose_measure_axis(const std::vector<const Measured*>& measured, bool bytes) {
  std::vector<double> values, ends;
  for (const Measured* each : measured) {
    if (!each->estimate) continue;
    values.push_back(each->estimate->value);
    ends.push_back(each->estimate->low);
    ends.push_back(each->estimate->high);
  }
  return choose_axis(values, ends, bytes ? TickKind::kBytes : TickKind::kNumber);
}

std::size_t place_of(const std::vector<std::string>& filters, const std::string& filter) {
  return static_cast<std::size_t>(std::find(filters.begin(), filters.end(), filter) - filters.begin());
}

PlotPoint make_point(const TradeFront& front, std::size_t i) { return {front.points[i].cost, front.points[i].error}; }

// One filter's cells of one standing.
PlotSeries make_series(const TradeScope& scope, const TradeFront& front, const std::string& filter, Standing standing) {
  PlotSeries series;
  for (std::size_t i = 0; i < front.points.size(); ++i) {
    if (scope.configurations[front.configurations[i]].filter != filter || front.placements[i].standing != standing)
      continue;
    series.points.push_back(make_point(front, i));
  }
  return series;
}

// The line through the members, with their numbers beside it.
PlotSeries make_front_line(const TradeFront& front) {
  PlotSeries line{"front", kInk, 0, PlotLine::kSteps, false, {}};
  for (const std::size_t member : front.members) {
    line.points.push_back(make_point(front, member));
    line.points.back().label = fmt::format("{}", line.points.size());
  }
  return line;
}

void add_filter(std::vector<PlotSeries>& series, const TradeScope& scope, const TradeFront& front,
                const std::string& filter, const PlotStyle& style) {
  const std::string color = style.color;
  const std::string faint = "#99" + color.substr(1);
  const std::tuple<Standing, int, std::string> looks[] = {{Standing::kDominated, style.hollow_point, faint},
                                                          {Standing::kTied, style.hollow_point, color},
                                                          {Standing::kFront, style.filled_point, color}};
  const std::size_t before = series.size();
  for (const auto& [standing, point_type, look] : looks) {
    PlotSeries one = make_series(scope, front, filter, standing);
    one.color = look;
    one.point_type = point_type;
    one.whiskers = true;
    if (!one.points.empty()) series.push_back(std::move(one));
  }
  if (series.size() > before) series.push_back({filter, color, style.filled_point, PlotLine::kNone, false, {}});
}

Plot make_front_plot(const TradeScope& scope, const TradeFront& front, const std::vector<std::string>& filters,
                     const GlRecord& gl) {
  const Measure &error = list_error_measures()[front.error], &cost = list_cost_measures()[front.cost];
  Plot plot{fmt::format("plots/{}.{}.{}.svg", scope.id, error.id, cost.id),
            scope.title,
            name_axis(cost, gl),
            name_axis(error, gl),
            choose_cost_axis(scope, front.cost),
            choose_error_axis(scope, front.error),
            {make_front_line(front)},
            {}};
  for (std::size_t i = 0; i < filters.size(); ++i) add_filter(plot.series, scope, front, filters[i], style_of(i));
  plot.series.push_back({"tied: hollow; dominated: faint", "#ffffff", 0, PlotLine::kNone, false, {}});
  for (std::size_t i = 0; i < front.members.size(); ++i) {
    plot.notes.push_back(
        fmt::format("{}: {}", i + 1, scope.configurations[front.configurations[front.members[i]]].label));
  }
  return plot;
}

const Estimate& time_of(const RadiusPoint& point, LightState light) {
  return light == LightState::kStill ? point.still : point.moving;
}

PlotSeries make_curve_series(const RadiusCurve& curve, LightState light, const PlotStyle& style) {
  PlotSeries series{
      curve.label, style.color, style.filled_point, curve.prefiltered ? PlotLine::kSolid : PlotLine::kDashed, true, {}};
  for (const RadiusPoint& p : curve.points)
    series.points.push_back({{p.radius_texels, p.radius_texels, p.radius_texels}, time_of(p, light)});
  return series;
}

PlotSeries make_crossings(const RadiusChart& chart, LightState light) {
  PlotSeries series{"crossing", kInk, 2, PlotLine::kNone, false, {}};
  for (const CurveComparison& each : compare_curves(chart, light)) {
    for (const RadiusPoint& p : each.crossings) {
      series.points.push_back(
          {{p.radius_texels, p.radius_texels, p.radius_texels}, time_of(p, light), format_number(p.radius_texels)});
    }
  }
  if (series.points.empty()) series.title.clear();
  return series;
}

Plot make_radius_plot(const RadiusChart& chart, LightState light, const std::vector<std::string>& filters,
                      const GlRecord& gl) {
  const bool still = light == LightState::kStill;
  std::vector<double> radii, times, ends;
  Plot plot{fmt::format("plots/{}.map{}.radius.{}.svg", chart.scope_id, chart.map_size, still ? "still" : "moving"),
            chart.title,
            "kernel half-width, texels",
            name_axis(list_cost_measures()[still ? 0 : 1], gl),
            {},
            {},
            {},
            {}};
  for (const RadiusCurve& curve : chart.curves) {
    plot.series.push_back(make_curve_series(curve, light, style_of(place_of(filters, curve.filter))));
    for (const PlotPoint& point : plot.series.back().points) {
      radii.push_back(point.x.value);
      times.push_back(point.y.value);
      ends.push_back(point.y.low);
      ends.push_back(point.y.high);
    }
  }
  plot.series.push_back(make_crossings(chart, light));
  plot.x = choose_axis(radii, {}, TickKind::kNumber);
  plot.y = choose_log_axis(times, ends);
  plot.notes = {"solid: prefiltered", "dashed: read at every lookup"};
  return plot;
}

PlotSeries make_light_series(const LightCurve& curve, LightState light, const PlotStyle& style) {
  const bool still = light == LightState::kStill;
  PlotSeries series{still ? curve.label : "",
                    style.color,
                    still ? style.filled_point : style.hollow_point,
                    still ? PlotLine::kSolid : PlotLine::kDashed,
                    true,
                    {}};
  for (const LightPoint& p : curve.points) {
    const double count = p.count;
    series.points.push_back({{count, count, count}, frame_time(p, light)});
  }
  return series;
}

PlotAxis make_count_axis(const std::vector<int>& counts) {
  PlotAxis axis{true, counts.front() / 1.12, counts.back() * 1.12, {}};
  for (const int count : counts) axis.ticks.push_back({count, fmt::format("{}", count)});
  return axis;
}

// What grows in proportion, from the corner of the plot on.
PlotSeries make_proportion(const LightChart& chart, const PlotAxis& y) {
  const double from = chart.counts.front(), to = std::min<double>(chart.counts.back(), from * y.high / y.low);
  return {"in proportion",
          "#9aa0a8",
          0,
          PlotLine::kSolid,
          false,
          {{{from, from, from}, {y.low, y.low, y.low}}, {{to, to, to}, {y.low * to / from, y.low, y.low}}}};
}

Plot make_light_plot(const LightChart& chart, const std::vector<std::string>& filters, const GlRecord& gl) {
  Plot plot{light_plot_file(chart),
            chart.title,
            "lights, each with a map of its own",
            fmt::format("time of a frame, ms: {}", describe_clock(gl)),
            make_count_axis(chart.counts),
            {},
            {},
            {}};
  std::vector<double> times, ends;
  for (const LightCurve& curve : chart.curves) {
    for (const LightState light : {LightState::kStill, LightState::kMoving}) {
      plot.series.push_back(make_light_series(curve, light, style_of(place_of(filters, curve.filter))));
      for (const PlotPoint& point : plot.series.back().points) {
        times.push_back(point.y.value);
        ends.insert(ends.end(), {point.y.low, point.y.high});
      }
    }
  }
  plot.y = choose_log_axis(times, ends);
  plot.series.insert(plot.series.begin(), make_proportion(chart, plot.y));
  plot.notes = {"solid: casters still", "dashed: casters moving"};
  return plot;
}

}  // namespace

PlotAxis choose_error_axis(const TradeScope& scope, std::size_t error) {
  std::vector<const Measured*> measured;
  for (const TradeConfiguration& each : scope.configurations) measured.push_back(&each.errors[error]);
  return choose_measure_axis(measured, false);
}

PlotAxis choose_cost_axis(const TradeScope& scope, std::size_t cost) {
  std::vector<const Measured*> measured;
  for (const TradeConfiguration& each : scope.configurations) measured.push_back(&each.costs[cost]);
  return choose_measure_axis(measured, list_cost_measures()[cost].is_bytes);
}

std::vector<Plot> make_front_plots(const std::vector<TradeScope>& scopes, const std::vector<std::string>& filters,
                                   const GlRecord& gl) {
  const std::pair<std::size_t, std::size_t> pairs[] = {{0, 0}, {0, 1}, {0, 2}, {0, 3}, {2, 0}, {2, 1}};
  std::vector<Plot> plots;
  for (const TradeScope& scope : scopes) {
    for (const auto& [error, cost] : pairs) {
      const TradeFront front = make_trade_front(scope, error, cost);
      if (front.points.size() > 1) plots.push_back(make_front_plot(scope, front, filters, gl));
    }
  }
  return plots;
}

std::vector<Plot> make_radius_plots(const std::vector<RadiusChart>& charts, const std::vector<std::string>& filters,
                                    const GlRecord& gl) {
  std::vector<Plot> plots;
  for (const RadiusChart& chart : charts)
    for (const LightState light : {LightState::kStill, LightState::kMoving})
      plots.push_back(make_radius_plot(chart, light, filters, gl));
  return plots;
}

std::string light_plot_file(const LightChart& chart) {
  return fmt::format("plots/{}.map{}.lights.svg", chart.scope_id, chart.map_size);
}

std::vector<Plot> make_light_plots(const std::vector<LightChart>& charts, const std::vector<std::string>& filters,
                                   const GlRecord& gl) {
  std::vector<Plot> plots;
  for (const LightChart& chart : charts)
    if (chart.counts.size() > 1) plots.push_back(make_light_plot(chart, filters, gl));
  return plots;
}

}  // namespace shadowbench::report
