#include "report/pages/trade_section.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <string>
#include <vector>

#include "filters/kernel.h"
#include "report/analysis/cells.h"
#include "report/analysis/trade.h"
#include "report/document/chart.h"
#include "report/records/format.h"

namespace shadowbench::pages {
namespace {

using document::ChartSeries;

constexpr const char* kFrontInk = "#a9aeb6";
constexpr document::ChartStyle kMarkStyle{document::kInk, document::Mark::kCircle};

document::ChartAxis choose_axis(const std::vector<analysis::Estimate>& estimates, bool bytes) {
  std::vector<double> values, ends;
  for (const analysis::Estimate& each : estimates) {
    values.push_back(each.value);
    ends.insert(ends.end(), {each.low, each.high});
  }
  return document::choose_axis(values, ends, bytes ? document::TickKind::kBytes : document::TickKind::kNumber);
}

/// An axis over all configurations of a scope that have the measure.
document::ChartAxis choose_measure_axis(const analysis::TradeScope& scope, const analysis::Quantity& quantity) {
  std::vector<analysis::Estimate> estimates;
  for (const analysis::Configuration& each : scope.configurations)
    if (const analysis::Measured measured = analysis::measure(each, quantity); measured.estimate)
      estimates.push_back(*measured.estimate);
  return choose_axis(estimates, quantity.is(analysis::CostKind::kBytes));
}

document::ChartStyle style_among(const std::vector<std::string>& filters, const std::string& filter) {
  return document::style_of(static_cast<std::size_t>(std::ranges::find(filters, filter) - filters.begin()));
}

analysis::Estimate exactly(double value) { return {value, value, value}; }

/// Points with whiskers, joined.
ChartSeries start_series(std::string title, const document::ChartStyle& style) {
  ChartSeries series = document::make_line(std::move(title), style);
  series.whiskers = true;
  return series;
}

std::string say_value(const analysis::Quantity& measure, const analysis::Estimate& estimate,
                      const records::GlRecord& gl) {
  const std::string unit = analysis::unit_of(measure, gl);
  return fmt::format("{}: {}{}{}", measure.title, analysis::format_estimate(measure, estimate), unit.empty() ? "" : " ",
                     unit);
}

/// Makes the chart of one front.
class FrontChart {
 public:
  FrontChart(const analysis::TradeScope& scope, const analysis::Quantity& error, const analysis::Quantity& cost,
             bool is_large, const records::GlRecord& gl)
      : scope_(scope), error_(error), cost_(cost), is_large_(is_large), gl_(gl) {}

  document::Chart make() const {
    document::Chart chart{fmt::format("{}.{}.{}", scope_.id, error_.id, cost_.id),
                          scope_.title,
                          analysis::name_axis(cost_, gl_),
                          analysis::name_axis(error_, gl_),
                          choose_measure_axis(scope_, cost_),
                          choose_measure_axis(scope_, error_),
                          {},
                          {}};
    add_fronts(chart);
    add_marks(chart);
    return chart;
  }

 private:
  /// A line through each front that has more than a point.
  void add_fronts(document::Chart& chart) const {
    std::map<std::size_t, ChartSeries> lines;
    for (std::size_t i = 0; i < points_.size(); ++i) {
      if (leaders_[i] != i || !points_[i].group) continue;
      ChartSeries& line =
          lines
              .try_emplace(
                  *points_[i].group,
                  ChartSeries{.title = {}, .color = kFrontInk, .line = document::LineStyle::kSteps, .points = {}})
              .first->second;
      line.points.push_back(make_corner(points_[i]));
    }
    for (auto& [group, line] : lines) {
      std::ranges::stable_sort(line.points, {}, [](const document::ChartPoint& point) { return point.x.value; });
      if (line.points.size() > 1) chart.series.push_back(std::move(line));
    }
  }

  static document::ChartPoint make_corner(const analysis::FrontPoint& point) {
    document::ChartPoint made{point.cost, point.error};
    made.group = analysis::name_class(point.group);
    return made;
  }

  document::ChartPoint make_point(const analysis::FrontPoint& point, std::string standing) const {
    const analysis::Configuration& configuration = *point.configuration;
    const records::CellRecord& cell = *configuration.cells.front();
    const records::ParamMap params = records::named_params(cell);
    document::ChartPoint made = make_corner(point);
    made.label = configuration.name;
    made.details = {configuration.name,
                    params.empty() ? "no parameters" : records::describe_params(params),
                    "kernel: " + records::describe_kernel(cell.kernel),
                    fmt::format("map {0} × {0}", cell.map_size),
                    say_value(error_, point.error, gl_),
                    say_value(cost_, point.cost, gl_),
                    std::move(standing)};
    const auto worst = std::ranges::max_element(configuration.cells, {},
                                                [](const auto* each) { return each->error.rmse.value_or(0.0); });
    made.opens = (*worst)->key;
    return made;
  }

  /// The cheapest cell of the front that a point is tied with: no dearer than it.
  const analysis::FrontPoint* find_tie(std::size_t i) const {
    const analysis::FrontPoint* tie = nullptr;
    for (std::size_t k = 0; k < points_.size(); ++k)
      if (k != i && leaders_[k] == k && points_[k].cost.value <= points_[i].cost.value &&
          analysis::is_tied(points_[k], points_[i]) && (!tie || points_[k].cost.value < tie->cost.value))
        tie = &points_[k];
    return tie;
  }

  /// Configurations on a front; tied with a cheaper one there, or compared with nothing; beaten.
  void add_marks(document::Chart& chart) const {
    ChartSeries members = start_series({}, kMarkStyle);
    members.line = document::LineStyle::kNone;
    ChartSeries tied = members, beaten = members;
    tied.filled = beaten.filled = false;
    beaten.faint = true;
    for (std::size_t i = 0; i < points_.size(); ++i) {
      const analysis::FrontPoint& own = points_[i];
      if (!own.group)
        tied.points.push_back(make_point(own, "compared with nothing: its kernel is of no class of width"));
      else if (const auto* tie = find_tie(i))
        tied.points.push_back(make_point(own, "tied with " + tie->configuration->name));
      else if (leaders_[i] == i)
        members.points.push_back(make_point(own, "on the front"));
      else if (!is_large_)
        beaten.points.push_back(make_point(own, "beaten by " + points_[leaders_[i]].configuration->name));
    }
    for (ChartSeries* each : {&beaten, &tied, &members})
      if (!each->points.empty()) chart.series.push_back(std::move(*each));
  }

  const analysis::TradeScope& scope_;
  const analysis::Quantity &error_, &cost_;
  bool is_large_;
  const records::GlRecord& gl_;
  const std::vector<analysis::FrontPoint> points_ = analysis::list_points(scope_, error_, cost_);
  const std::vector<std::size_t> leaders_ = analysis::find_front(points_);
};

/// A logarithmic axis for what series have on the y axis.
document::ChartAxis choose_y_axis(const std::vector<ChartSeries>& series) {
  std::vector<double> values, ends;
  for (const ChartSeries& each : series) {
    for (const document::ChartPoint& point : each.points) {
      values.push_back(point.y.value);
      ends.insert(ends.end(), {point.y.low, point.y.high});
    }
  }
  return document::choose_log_axis(values, ends);
}

/// Cost over the kernel's width, of one state of the light: kMovingCost or kStaticCost.
document::Chart make_width_chart(const analysis::CostChart& chart, std::size_t light, const analysis::Quantity& cost,
                                 const std::vector<std::string>& filters, const records::GlRecord& gl) {
  document::Chart made;
  made.id = fmt::format("{}.width.{}", chart.id, light == analysis::kStaticCost ? "static" : "moving");
  made.title = chart.title;
  made.x_name = "kernel width (standard deviation), texels";
  made.y_name = analysis::name_axis(cost, gl);
  for (const analysis::CostCurve& curve : chart.curves) {
    ChartSeries& series = made.series.emplace_back(start_series(curve.label, style_among(filters, curve.filter)));
    if (!curve.prefiltered) series.line = document::LineStyle::kDashed;
    for (const analysis::CurvePoint& p : curve.points)
      series.points.push_back({exactly(p.sigma_texels),
                               p.costs[light],
                               {},
                               {curve.label, fmt::format("kernel {} texels", records::format_number(p.sigma_texels)),
                                say_value(cost, p.costs[light], gl)}});
  }
  made.x = document::choose_axis(chart.widths(), {}, document::TickKind::kNumber);
  made.y = choose_y_axis(made.series);
  made.notes = {"solid: prefiltered", "dashed: read at every lookup"};
  return made;
}

document::ChartChoice make_front_choice(const std::vector<analysis::TradeScope>& scopes,
                                        const std::vector<analysis::Quantity>& costs, bool is_large,
                                        const records::GlRecord& gl) {
  document::ChartChoice choice{"front", {{"scene", {}}, {"error", {}}, {"cost", {}}}, {}};
  for (const analysis::Quantity& error : analysis::list_error_measures())
    choice.selectors[1].options.push_back(error.title);
  for (const analysis::Quantity& cost : costs) {
    choice.selectors[2].options.push_back(cost.title);
    choice.selectors[2].costs.push_back(cost.id);
  }
  for (const analysis::TradeScope& scope : scopes) {
    choice.selectors[0].options.push_back(scope.title);
    for (const analysis::Quantity& error : analysis::list_error_measures())
      for (const analysis::Quantity& cost : costs)
        choice.charts.push_back(FrontChart(scope, error, cost, is_large, gl).make());
  }
  return choice;
}

document::ChartChoice make_width_choice(const std::vector<analysis::CostChart>& charts,
                                        const std::vector<analysis::Quantity>& costs,
                                        const std::vector<std::string>& filters, const records::GlRecord& gl) {
  document::ChartChoice choice{
      "width", {{"where", {}}, {"light", {"static: lookup", "moving: map, prefilter, lookup"}}}, {}};
  for (const analysis::CostChart& chart : charts) {
    choice.selectors[0].options.push_back(chart.title);
    for (const std::size_t light : {analysis::kStaticCost, analysis::kMovingCost})
      choice.charts.push_back(make_width_chart(chart, light, costs[light], filters, gl));
  }
  return choice;
}

constexpr const char* kFrontsNote =
    "Lower left is better. Line: the Pareto front of a class of width. Hollow: tied with a cheaper one of the front. "
    "Pale: beaten. Ringed: the answers.";
constexpr const char* kLargeNote = "The run has more than {} cells: beaten ones are left out of these charts.";

/// How fronts are read: what beaten and tied mean, what the intervals are, how scenes are combined, and what each of
/// `costs` is.
std::vector<std::string> explain_fronts(const std::vector<analysis::Quantity>& costs) {
  std::vector<std::string> sentences = {
      fmt::format(
          "Only filters whose kernels are about equally wide are compared: a wider kernel makes a softer shadow, "
          "and is no worse filter. Kernel width is the standard deviation along an axis, in texels; each "
          "class has a front of its own: {}.",
          filters::describe_classes()),
      "A cell is beaten where another of its class costs no more and has no larger error; of several, the cheapest is "
      "named. It is tied with a cheaper cell of the front where neither differs clearly: errors where the 95 % "
      "interval "
      "of their difference, which is taken group by group of the phases that all cells share, does not hold 0; times "
      "whose 95 % intervals do not overlap; everything else where the numbers differ.",
      "A map that is fitted to the scene (tight, sphere) serves every camera, and can be kept while light and casters "
      "stand still; every other fit follows a camera, and is drawn anew whenever it moves."};
  const auto explain = [&](const analysis::Quantity& measure) {
    sentences.push_back(
        fmt::format("{}: {}. All scenes together: {}.", measure.title, measure.meaning, measure.over_scenes));
  };
  std::ranges::for_each(analysis::list_error_measures(), explain);
  std::ranges::for_each(costs, explain);
  return sentences;
}

}  // namespace

std::optional<document::Section> make_trade_section(const records::RunRecord& run,
                                                    const std::vector<records::CellRecord>& cells) {
  const std::vector<analysis::Quantity> costs = analysis::list_cost_measures(cells);
  const std::vector<analysis::TradeScope> scopes = analysis::make_trade_scopes(cells);
  if (!analysis::has_trade(scopes, costs)) return std::nullopt;
  document::Section section{"trade", "The trade", {document::Paragraph{kFrontsNote, true}}};
  const bool is_large = cells.size() > kMostCellsInDetail;
  if (is_large) section.blocks.emplace_back(document::Paragraph{fmt::format(kLargeNote, kMostCellsInDetail), true});
  section.blocks.emplace_back(make_front_choice(scopes, costs, is_large, run.gl));
  section.blocks.emplace_back(
      document::Details{"How to read the fronts", {document::Sentences{{}, explain_fronts(costs)}}});
  document::ChartChoice widths =
      make_width_choice(analysis::make_width_charts(scopes, costs), costs, analysis::list_filters(cells), run.gl);
  if (!widths.charts.empty())
    section.blocks.emplace_back(document::Details{"Cost over the kernel width", {std::move(widths)}});
  return section;
}

}  // namespace shadowbench::pages
