#include "report/pages/trade_section.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <string>
#include <vector>

#include "base/files.h"
#include "filters/kernel.h"
#include "report/analysis/cells.h"
#include "report/analysis/trade.h"
#include "report/document/chart.h"
#include "report/pages/tables.h"
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
class WidthChart {
 public:
  WidthChart(const analysis::CostChart& chart, std::size_t light, const analysis::Quantity& cost,
             const records::GlRecord& gl)
      : chart_(chart), light_(light), cost_(cost), gl_(gl) {}

  document::Chart make(const std::vector<std::string>& filters) const {
    document::Chart made;
    const char* state = light_ == analysis::kStaticCost ? "static" : "moving";
    made.id = fmt::format("{}.width.{}", chart_.id, state);
    made.title = chart_.title;
    made.x_name = "kernel width (standard deviation), texels";
    made.y_name = analysis::name_axis(cost_, gl_);
    for (const analysis::CostCurve& curve : chart_.curves)
      made.series.push_back(make_series(curve, style_among(filters, curve.filter)));
    made.x = document::choose_axis(chart_.widths(), {}, document::TickKind::kNumber);
    made.y = choose_y_axis(made.series);
    made.notes = {"solid: prefiltered", "dashed: read at every lookup"};
    return made;
  }

 private:
  ChartSeries make_series(const analysis::CostCurve& curve, const document::ChartStyle& style) const {
    ChartSeries series = start_series(curve.label, style);
    if (!curve.prefiltered) series.line = document::LineStyle::kDashed;
    for (const analysis::CurvePoint& p : curve.points)
      series.points.push_back({exactly(p.sigma_texels),
                               p.costs[light_],
                               {},
                               {curve.label, fmt::format("kernel {} texels", records::format_number(p.sigma_texels)),
                                say_value(cost_, p.costs[light_], gl_)}});
    return series;
  }

  const analysis::CostChart& chart_;
  std::size_t light_;
  const analysis::Quantity& cost_;
  const records::GlRecord& gl_;
};

/// The maps of a filter: RMSE over their bytes, a curve for each fit.
document::Chart make_map_chart(const analysis::MapFamily& family, const analysis::Quantity& cost,
                               const records::GlRecord& gl) {
  document::Chart made;
  made.title = family.title;
  made.id = "maps." + make_file_stem(made.title);
  made.x_name = "bytes of the map, all layers";
  made.y_name = analysis::list_error_measures()[0].title;
  std::vector<double> bytes;
  std::map<std::string, double> least;
  for (const analysis::MapPoint& map : family.maps) {
    bytes.push_back(map.bytes);
    auto series = std::ranges::find(made.series, map.name, &ChartSeries::title);
    if (series == made.series.end()) {
      made.series.push_back(start_series(map.name, document::style_of(made.series.size())));
      series = std::prev(made.series.end());
    }
    series->points.push_back({exactly(map.bytes),
                              map.rmse,
                              fmt::format("{}", map.size),
                              {map.name, fmt::format("{0} × {0} texels a layer", map.size),
                               fmt::format("RMSE {}{}", records::format_number(map.rmse.value),
                                           map.seam ? ", seam " + records::format_number(map.seam) : ""),
                               say_value(cost, map.cost, gl)}});
    least[map.name] = -map.rmse.value;  // of its largest map
  }
  made.x = document::choose_axis(bytes, bytes, document::TickKind::kBytes);
  made.y = choose_y_axis(made.series);
  std::vector<std::pair<double, std::string>> weights;
  for (const auto& [name, weight] : least) weights.emplace_back(weight, name);
  document::show_most_telling(made, weights);
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
      choice.charts.push_back(WidthChart(chart, light, costs[light], gl).make(filters));
  }
  return choice;
}

document::ChartChoice make_map_choice(const std::vector<analysis::MapFamily>& families, const analysis::Quantity& cost,
                                      const records::GlRecord& gl) {
  document::ChartChoice choice{"maps", {{"filter", {}}}, {}};
  for (const analysis::MapFamily& family : families) {
    choice.charts.push_back(make_map_chart(family, cost, gl));
    choice.selectors[0].options.push_back(choice.charts.back().title);
  }
  return choice;
}

using Blocks = std::vector<document::Block>;

constexpr const char* kFrontsNote =
    "Lower left is better. Line: the Pareto front of a class of width. Hollow: tied with a cheaper one of the front. "
    "Pale: beaten. Ringed: the answers.";
constexpr const char* kLargeNote = "The run has more than {} cells: beaten ones are left out of these charts.";
constexpr const char* kMapsNote =
    "A map that is fitted to the scene (tight, sphere) serves every camera, and can be kept while light and casters "
    "stand still; every other fit follows a camera, and is drawn anew whenever it moves.";

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
      "whose 95 % intervals do not overlap; everything else where the numbers differ."};
  const auto explain = [&](const analysis::Quantity& measure) {
    sentences.push_back(
        fmt::format("{}: {}. All scenes together: {}.", measure.title, measure.meaning, measure.over_scenes));
  };
  std::ranges::for_each(analysis::list_error_measures(), explain);
  std::ranges::for_each(costs, explain);
  return sentences;
}

void add_charts(Blocks& blocks, const char* heading, document::ChartChoice charts, const char* note) {
  if (charts.charts.empty()) return;
  document::Details details{heading, {std::move(charts)}};
  if (note) details.blocks.emplace_back(document::Paragraph{note, true});
  blocks.emplace_back(std::move(details));
}

}  // namespace

std::optional<document::Section> make_trade_section(const records::RunRecord& run,
                                                    const std::vector<records::CellRecord>& cells) {
  const std::vector<analysis::Quantity> costs = analysis::list_cost_measures(cells);
  const std::vector<analysis::TradeScope> scopes = analysis::make_trade_scopes(cells);
  const auto all = analysis::point_to(cells);
  const std::vector<analysis::MapFamily> families = analysis::list_map_families(all);
  const bool has_fronts = analysis::has_trade(scopes, costs);
  if (!has_fronts && families.empty()) return std::nullopt;
  document::Section section{"trade", "The trade", {}};
  if (has_fronts) {
    const bool is_large = cells.size() > kMostCellsInDetail;
    section.blocks = {document::Paragraph{kFrontsNote, true}};
    if (is_large) section.blocks.emplace_back(document::Paragraph{fmt::format(kLargeNote, kMostCellsInDetail), true});
    section.blocks.emplace_back(make_front_choice(scopes, costs, is_large, run.gl));
    section.blocks.emplace_back(
        document::Details{"How to read the fronts", {document::Sentences{{}, explain_fronts(costs)}}});
    add_charts(
        section.blocks, "Cost over the kernel width",
        make_width_choice(analysis::make_width_charts(scopes, costs), costs, analysis::list_filters(cells), run.gl),
        nullptr);
  }
  add_charts(section.blocks, "Error of maps of several fits, over their bytes",
             make_map_choice(families, analysis::make_map_measure(all), run.gl), kMapsNote);
  return section;
}

}  // namespace shadowbench::pages
