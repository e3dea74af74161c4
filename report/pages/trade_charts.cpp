#include "report/pages/trade_charts.h"

#include <fmt/format.h>

#include <algorithm>
#include <span>

#include "report/analysis/cell_group.h"
#include "report/page/chart_style.h"
#include "report/pages/large_run.h"
#include "report/records/format.h"

namespace shadowbench::pages {
namespace {

using Configuration = analysis::TradeConfiguration;
using page::ChartSeries;

/// An axis over all configurations of a scope that have the measure.
page::ChartAxis choose_measure_axis(const analysis::TradeScope& scope, const auto& values_of, bool bytes) {
  std::vector<double> values, ends;
  for (const Configuration& configuration : scope.configurations) {
    const analysis::Measured& measured = values_of(configuration);
    if (!measured.estimate) continue;
    values.push_back(measured.estimate->value);
    ends.insert(ends.end(), {measured.estimate->low, measured.estimate->high});
  }
  return page::choose_axis(values, ends, bytes ? page::TickKind::kBytes : page::TickKind::kNumber);
}

page::ChartStyle style_among(const std::vector<std::string>& filters, const std::string& filter) {
  return page::style_of(static_cast<std::size_t>(std::ranges::find(filters, filter) - filters.begin()));
}

analysis::Estimate exactly(double value) { return {value, value, value}; }

ChartSeries start_series(std::string title, const page::ChartStyle& style) {
  ChartSeries series;
  series.title = std::move(title);
  series.color = style.color;
  series.mark = style.mark;
  series.whiskers = true;
  return series;
}

ChartSeries start_line(std::string title, const char* color, page::LineStyle line) {
  ChartSeries series;
  series.title = std::move(title);
  series.color = color;
  series.line = line;
  return series;
}

std::string say_value(const analysis::Measure& measure, const analysis::Estimate& estimate,
                      const records::GlRecord& gl) {
  return fmt::format("{}: {}{}", measure.name, analysis::format_estimate(measure, estimate),
                     measure.is_time ? " " + records::time_unit(gl) : std::string());
}

/// Makes the chart of one front.
class FrontChart {
 public:
  FrontChart(const analysis::TradeScope& scope, const analysis::TradeFront& front,
             const std::vector<records::CellRecord>& cells, const records::GlRecord& gl)
      : scope_(scope), front_(front), cells_(cells), gl_(gl) {}

  page::Chart make(const std::vector<std::string>& filters) const {
    const auto cost_of = [this](const Configuration& each) -> const auto& { return each.costs[front_.cost]; };
    const auto error_of = [this](const Configuration& each) -> const auto& { return each.errors[front_.error]; };
    page::Chart chart{fmt::format("{}.{}.{}", scope_.id, error_.id, cost_.id),
                      scope_.title,
                      analysis::name_axis(cost_, gl_),
                      analysis::name_axis(error_, gl_),
                      choose_measure_axis(scope_, cost_of, cost_.is_bytes),
                      choose_measure_axis(scope_, error_of, false),
                      {},
                      {}};
    add_fronts(chart);
    for (const std::string& filter : filters) add_filter(chart.series, filter, style_among(filters, filter));
    return chart;
  }

 private:
  const Configuration& configuration_of(std::size_t point) const {
    return scope_.configurations[front_.configurations[point]];
  }

  /// A line through each front that has more than a point.
  void add_fronts(page::Chart& chart) const {
    for (auto first = front_.members.begin(); first != front_.members.end();) {
      const auto group = front_.points[*first].group;
      const auto last = std::find_if(first, front_.members.end(),
                                     [&](std::size_t member) { return front_.points[member].group != group; });
      if (last - first > 1) chart.series.push_back(make_front({first, last}));
      first = last;
    }
  }

  ChartSeries make_front(std::span<const std::size_t> members) const {
    const Configuration& configuration = configuration_of(members.front());
    const std::string name(analysis::name_class(configuration.width_class));
    const std::string map = cost_.is_ratio ? fmt::format(", map {}", configuration.map_size) : std::string();
    ChartSeries line = start_line(fmt::format("front, {}{}", name, map), page::kInk, page::LineStyle::kSteps);
    for (const std::size_t member : members)
      line.points.push_back({front_.points[member].cost, front_.points[member].error, {}, {}, {}, name});
    return line;
  }

  std::string describe_standing(std::size_t point) const {
    const analysis::Placement& placement = front_.placements[point];
    const std::string& leader = configuration_of(placement.by).label;
    return placement.standing == analysis::Standing::kFront  ? "on the front"
           : placement.standing == analysis::Standing::kTied ? "tied with " + leader
           : placement.standing == analysis::Standing::kApart
               ? "compared with nothing: its kernel is of no class of width"
               : "beaten by " + leader;
  }

  page::ChartPoint make_point(std::size_t point) const {
    const Configuration& configuration = configuration_of(point);
    const analysis::FrontPoint& values = front_.points[point];
    page::ChartPoint made{values.cost, values.error, configuration.label};
    made.group = analysis::name_class(configuration.width_class);
    made.details = {configuration.label,
                    configuration.params.empty() ? "no parameters" : records::describe_params(configuration.params),
                    "kernel: " + records::describe_kernel(cells_[configuration.cells.front()].kernel),
                    fmt::format("map {0} × {0}", configuration.map_size),
                    say_value(error_, values.error, gl_),
                    say_value(cost_, values.cost, gl_),
                    describe_standing(point)};
    const auto worst = std::ranges::max_element(configuration.cells, {},
                                                [&](std::size_t i) { return cells_[i].error.rmse.value_or(0.0); });
    made.opens = cells_[*worst].key;
    return made;
  }

  /// A filter's cells: on a front; tied, with dotted lines to what they are tied with, or compared with nothing;
  /// beaten.
  void add_filter(std::vector<ChartSeries>& series, const std::string& filter, const page::ChartStyle& style) const {
    ChartSeries members = start_series(filter, style), tied = start_series({}, style), beaten = start_series({}, style);
    ChartSeries ties = start_line({}, style.color, page::LineStyle::kTies);
    tied.filled = beaten.filled = false;
    beaten.faint = true;
    for (std::size_t i = 0; i < front_.points.size(); ++i) {
      const auto [standing, by] = front_.placements[i];
      if (configuration_of(i).filter != filter || (is_large_ && standing == analysis::Standing::kDominated)) continue;
      ChartSeries& own = standing == analysis::Standing::kFront       ? members
                         : standing == analysis::Standing::kDominated ? beaten
                                                                      : tied;
      own.points.push_back(make_point(i));
      if (standing != analysis::Standing::kTied) continue;
      for (const std::size_t end : {i, by})
        ties.points.push_back({front_.points[end].cost,
                               front_.points[end].error,
                               {},
                               {},
                               {},
                               std::string(analysis::name_class(configuration_of(i).width_class))});
    }
    if (members.points.empty() && tied.points.empty() && beaten.points.empty()) return;
    series.push_back(std::move(members));
    for (ChartSeries* more : {&tied, &beaten, &ties})
      if (!more->points.empty()) series.push_back(std::move(*more));
    for (const analysis::WidthSeries& each : widths_)
      if (each.filter == filter && each.configurations.size() > 1) series.push_back(make_curve(each, style));
  }

  /// The line through a filter's cells from narrow to wide: its curve over the width.
  ChartSeries make_curve(const analysis::WidthSeries& each, const page::ChartStyle& style) const {
    ChartSeries curve = start_line({}, style.color, page::LineStyle::kSolid);
    curve.faint = true;
    for (const std::size_t i : each.configurations) {
      const Configuration& configuration = scope_.configurations[i];
      curve.points.push_back({*configuration.costs[front_.cost].estimate,
                              *configuration.errors[front_.error].estimate,
                              {},
                              {},
                              {},
                              std::string(analysis::name_class(configuration.width_class))});
    }
    return curve;
  }

  const analysis::TradeScope& scope_;
  const analysis::TradeFront& front_;
  const std::vector<records::CellRecord>& cells_;
  const records::GlRecord& gl_;
  const analysis::Measure& error_ = analysis::list_error_measures()[front_.error];
  const analysis::Measure& cost_ = scope_.costs[front_.cost];
  const bool is_large_ = cells_.size() > kMostCellsInDetail;
  const std::vector<analysis::WidthSeries> widths_ =
      is_large_ ? std::vector<analysis::WidthSeries>()
                : analysis::list_width_series(scope_.configurations, front_.configurations);
};

const analysis::Estimate& time_of(const analysis::WidthPoint& point, analysis::LightState light) {
  return light == analysis::LightState::kStill ? point.still : point.moving;
}

/// A logarithmic axis for the times that series have on the y axis.
page::ChartAxis choose_time_axis(const std::vector<ChartSeries>& series) {
  std::vector<double> times, ends;
  for (const ChartSeries& each : series) {
    for (const page::ChartPoint& point : each.points) {
      times.push_back(point.y.value);
      ends.insert(ends.end(), {point.y.low, point.y.high});
    }
  }
  return page::choose_log_axis(times, ends);
}

ChartSeries make_width_series(const analysis::WidthCurve& curve, analysis::LightState light,
                              const page::ChartStyle& style) {
  ChartSeries series = start_series(curve.label, style);
  series.line = curve.prefiltered ? page::LineStyle::kSolid : page::LineStyle::kDashed;
  for (const analysis::WidthPoint& p : curve.points)
    series.points.push_back({exactly(p.sigma_texels), time_of(p, light)});
  return series;
}

ChartSeries make_crossings(const analysis::WidthChart& chart, analysis::LightState light) {
  ChartSeries series;
  series.color = page::kInk;
  series.mark = page::Mark::kCross;
  for (const analysis::CurveComparison& each : analysis::compare_curves(chart, light)) {
    for (const analysis::WidthPoint& p : each.crossings) {
      const std::string width = records::format_number(p.sigma_texels);
      series.points.push_back({exactly(p.sigma_texels),
                               time_of(p, light),
                               width,
                               {chart.curves[each.prefiltered].label + " × " + chart.curves[each.taps].label,
                                fmt::format("kernel {} texels", width)}});
    }
  }
  if (!series.points.empty()) series.title = "crossing";
  return series;
}

page::Chart make_width_chart(const analysis::WidthChart& chart, analysis::LightState light,
                             const std::vector<std::string>& filters, const records::GlRecord& gl) {
  const bool still = light == analysis::LightState::kStill;
  const analysis::Measure& cost = chart.costs[still ? analysis::kStillCost : analysis::kMovingCost];
  page::Chart made;
  made.id = fmt::format("{}.map{}.width.{}", chart.scope_id, chart.map_size, still ? "still" : "moving");
  made.title = chart.title;
  made.x_name = "kernel's width (standard deviation), texels";
  made.y_name = analysis::name_axis(cost, gl);
  std::vector<double> widths;
  for (const analysis::WidthCurve& curve : chart.curves) {
    made.series.push_back(make_width_series(curve, light, style_among(filters, curve.filter)));
    for (page::ChartPoint& point : made.series.back().points) {
      widths.push_back(point.x.value);
      point.details = {curve.label, fmt::format("kernel {} texels", records::format_number(point.x.value)),
                       say_value(cost, point.y, gl)};
    }
  }
  made.x = page::choose_axis(widths, {}, page::TickKind::kNumber);
  made.y = choose_time_axis(made.series);
  made.series.push_back(make_crossings(chart, light));
  made.notes = {"solid: prefiltered", "dashed: read at every lookup"};
  return made;
}

ChartSeries make_light_series(const analysis::LightCurve& curve, analysis::LightState light,
                              const page::ChartStyle& style) {
  const bool still = light == analysis::LightState::kStill;
  ChartSeries series = start_series(still ? curve.label : "", style);
  series.filled = still;
  series.line = still ? page::LineStyle::kSolid : page::LineStyle::kDashed;
  for (const analysis::LightPoint& p : curve.points) {
    const analysis::Estimate& time = analysis::frame_time(p, light);
    series.points.push_back(
        {exactly(p.count),
         time,
         {},
         {fmt::format("{}, casters {}", curve.label, still ? "still" : "moving"), fmt::format("lights: {}", p.count),
          fmt::format("time of a frame: {} ms", analysis::format_time(time))}});
  }
  return series;
}

page::ChartAxis make_count_axis(const std::vector<int>& counts) {
  page::ChartAxis axis{true, counts.front() / 1.12, counts.back() * 1.12, {}};
  for (const int count : counts) axis.ticks.push_back({count, fmt::format("{}", count)});
  return axis;
}

/// What grows in proportion, from the corner of the chart on.
ChartSeries make_proportion(const analysis::LightChart& chart, const page::ChartAxis& y) {
  const double from = chart.counts.front(), to = std::min<double>(chart.counts.back(), from * y.high / y.low);
  ChartSeries line = start_line("in proportion", "#9aa0a8", page::LineStyle::kSolid);
  line.points = {{exactly(from), exactly(y.low)}, {exactly(to), exactly(y.low * to / from)}};
  return line;
}

}  // namespace

page::ChartChoice make_front_choice(const std::vector<analysis::TradeScope>& scopes,
                                    const std::vector<records::CellRecord>& cells, const records::GlRecord& gl) {
  const std::vector<std::string> filters = analysis::list_filters(cells);
  page::ChartChoice choice{"front", {{"scene", {}}, {"error", {}}, {"cost", {}}}, {}};
  for (const analysis::Measure& error : analysis::list_error_measures())
    choice.selectors[1].options.push_back(error.name);
  for (const analysis::Measure& cost : analysis::list_cost_measures(cells))
    choice.selectors[2].options.push_back(cost.name);
  for (const analysis::TradeScope& scope : scopes) {
    choice.selectors[0].options.push_back(scope.title);
    for (std::size_t error = 0; error < analysis::kErrorMeasures; ++error) {
      for (std::size_t cost = 0; cost < scope.costs.size(); ++cost) {
        const analysis::TradeFront front = analysis::make_trade_front(scope, error, cost);
        choice.charts.push_back(FrontChart(scope, front, cells, gl).make(filters));
      }
    }
  }
  return choice;
}

page::ChartChoice make_width_choice(const std::vector<analysis::WidthChart>& charts,
                                    const std::vector<std::string>& filters, const records::GlRecord& gl) {
  page::ChartChoice choice{
      "width", {{"where", {}}, {"light", {"still: lookup", "moving: map, prefilter, lookup"}}}, {}};
  for (const analysis::WidthChart& chart : charts) {
    choice.selectors[0].options.push_back(chart.title);
    for (const analysis::LightState light : {analysis::LightState::kStill, analysis::LightState::kMoving})
      choice.charts.push_back(make_width_chart(chart, light, filters, gl));
  }
  return choice;
}

page::Chart make_light_chart(const analysis::LightChart& chart, const std::vector<std::string>& filters,
                             const records::GlRecord& gl) {
  page::Chart made;
  made.id = fmt::format("{}.map{}.lights", chart.scope_id, chart.map_size);
  made.title = chart.title;
  made.x_name = "lights, each with a map of its own";
  made.y_name = fmt::format("time of a frame, ms: {}", records::describe_clock(gl));
  made.x = make_count_axis(chart.counts);
  for (const analysis::LightCurve& curve : chart.curves)
    for (const analysis::LightState light : {analysis::LightState::kStill, analysis::LightState::kMoving})
      made.series.push_back(make_light_series(curve, light, style_among(filters, curve.filter)));
  made.y = choose_time_axis(made.series);
  made.series.push_back(make_proportion(chart, made.y));
  made.notes = {"solid, filled: casters still", "dashed, hollow: casters moving"};
  return made;
}

}  // namespace shadowbench::pages
