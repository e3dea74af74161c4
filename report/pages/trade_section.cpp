#include "report/pages/trade_section.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <span>

#include "filters/kernel.h"
#include "report/analysis/cells.h"
#include "report/files/file_name.h"
#include "report/pages/tables.h"
#include "report/records/format.h"

namespace shadowbench::pages {
namespace {

using Configuration = analysis::TradeConfiguration;
using document::ChartSeries;

constexpr const char* kFrontInk = "#a9aeb6";
constexpr document::ChartStyle kMarkStyle{document::kInk, document::Mark::kCircle};

/// An axis over all configurations of a scope that have the measure.
document::ChartAxis choose_measure_axis(const analysis::TradeScope& scope, const auto& values_of, bool bytes) {
  std::vector<double> values, ends;
  for (const Configuration& configuration : scope.configurations) {
    const analysis::Measured& measured = values_of(configuration);
    if (!measured.estimate) continue;
    values.push_back(measured.estimate->value);
    ends.insert(ends.end(), {measured.estimate->low, measured.estimate->high});
  }
  return document::choose_axis(values, ends, bytes ? document::TickKind::kBytes : document::TickKind::kNumber);
}

document::ChartStyle style_among(const std::vector<std::string>& filters, const std::string& filter) {
  return document::style_of(static_cast<std::size_t>(std::ranges::find(filters, filter) - filters.begin()));
}

analysis::Estimate exactly(double value) { return {value, value, value}; }

ChartSeries start_series(std::string title, const document::ChartStyle& style) {
  ChartSeries series;
  series.title = std::move(title);
  series.color = style.color;
  series.mark = style.mark;
  series.whiskers = true;
  return series;
}

ChartSeries start_line(std::string title, const char* color, document::LineStyle line) {
  ChartSeries series;
  series.title = std::move(title);
  series.color = color;
  series.line = line;
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
  FrontChart(const analysis::TradeScope& scope, const analysis::TradeFront& front,
             const std::vector<records::CellRecord>& cells, const records::GlRecord& gl)
      : scope_(scope), front_(front), cells_(cells), gl_(gl) {}

  document::Chart make() const {
    const auto cost_of = [this](const Configuration& each) -> const auto& { return each.costs[front_.cost]; };
    const auto error_of = [this](const Configuration& each) -> const auto& { return each.errors[front_.error]; };
    document::Chart chart{fmt::format("{}.{}.{}", scope_.id, error_.id, cost_.id),
                          scope_.title,
                          analysis::name_axis(cost_, gl_),
                          analysis::name_axis(error_, gl_),
                          choose_measure_axis(scope_, cost_of, cost_.is(analysis::CostKind::kBytes)),
                          choose_measure_axis(scope_, error_of, false),
                          {},
                          {}};
    add_fronts(chart);
    add_marks(chart);
    return chart;
  }

 private:
  const Configuration& configuration_of(std::size_t point) const {
    return scope_.configurations[front_.configurations[point]];
  }

  /// A line through each front that has more than a point.
  void add_fronts(document::Chart& chart) const {
    for (auto first = front_.members.begin(); first != front_.members.end();) {
      const auto group = front_.points[*first].group;
      const auto last = std::find_if(first, front_.members.end(),
                                     [&](std::size_t member) { return front_.points[member].group != group; });
      if (last - first > 1) chart.series.push_back(make_front({first, last}));
      first = last;
    }
  }

  ChartSeries make_front(std::span<const std::size_t> members) const {
    ChartSeries line = start_line({}, kFrontInk, document::LineStyle::kSteps);
    for (const std::size_t member : members) line.points.push_back(make_corner(member));
    return line;
  }

  document::ChartPoint make_corner(std::size_t point) const {
    document::ChartPoint made{front_.points[point].cost, front_.points[point].error};
    made.group = analysis::name_class(configuration_of(point).width_class);
    return made;
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

  document::ChartPoint make_point(std::size_t point) const {
    const Configuration& configuration = configuration_of(point);
    const analysis::FrontPoint& values = front_.points[point];
    document::ChartPoint made = make_corner(point);
    made.label = configuration.label;
    made.details = {configuration.label,
                    configuration.params.empty() ? "no parameters" : records::describe_params(configuration.params),
                    "kernel: " + records::describe_kernel(configuration.cells.front()->kernel),
                    fmt::format("map {0} × {0}", configuration.map_size),
                    say_value(error_, values.error, gl_),
                    say_value(cost_, values.cost, gl_),
                    describe_standing(point)};
    const auto worst = std::ranges::max_element(configuration.cells, {},
                                                [](const auto* cell) { return cell->error.rmse.value_or(0.0); });
    made.opens = (*worst)->key;
    return made;
  }

  /// Configurations on a front; tied, or compared with nothing; beaten.
  void add_marks(document::Chart& chart) const {
    ChartSeries members = start_series({}, kMarkStyle), tied = members, beaten = members;
    tied.filled = beaten.filled = false;
    beaten.faint = true;
    for (std::size_t i = 0; i < front_.points.size(); ++i) {
      const analysis::Standing standing = front_.placements[i].standing;
      if (standing == analysis::Standing::kFront)
        members.points.push_back(make_point(i));
      else if (standing != analysis::Standing::kDominated)
        tied.points.push_back(make_point(i));
      else if (cells_.size() <= kMostCellsInDetail)
        beaten.points.push_back(make_point(i));
    }
    for (ChartSeries* each : {&beaten, &tied, &members})
      if (!each->points.empty()) chart.series.push_back(std::move(*each));
  }

  const analysis::TradeScope& scope_;
  const analysis::TradeFront& front_;
  const std::vector<records::CellRecord>& cells_;
  const records::GlRecord& gl_;
  const analysis::Quantity& error_ = analysis::list_error_measures()[front_.error];
  const analysis::Quantity& cost_ = scope_.costs[front_.cost];
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
  WidthChart(const analysis::CostChart& chart, std::size_t light, const records::GlRecord& gl)
      : chart_(chart), light_(light), gl_(gl) {}

  document::Chart make(const std::vector<std::string>& filters) const {
    document::Chart made;
    const char* state = light_ == analysis::kStaticCost ? "static" : "moving";
    made.id = fmt::format("{}.map{}.width.{}", chart_.scope_id, chart_.map_size, state);
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
    series.line = curve.prefiltered ? document::LineStyle::kSolid : document::LineStyle::kDashed;
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
  const records::GlRecord& gl_;
  const analysis::Quantity& cost_ = chart_.costs[light_];
};

/// The maps of a filter: RMSE over their bytes, a curve for each fit.
document::Chart make_map_chart(const analysis::MapFamily& family, const analysis::Quantity& cost,
                               const records::GlRecord& gl) {
  document::Chart made;
  made.title = family.title;
  made.id = "maps." + files::make_file_stem(made.title);
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
      series->line = document::LineStyle::kSolid;
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

}  // namespace

document::ChartChoice make_front_choice(const std::vector<analysis::TradeScope>& scopes,
                                        const std::vector<records::CellRecord>& cells, const records::GlRecord& gl) {
  document::ChartChoice choice{"front", {{"scene", {}}, {"error", {}}, {"cost", {}}}, {}};
  for (const analysis::Quantity& error : analysis::list_error_measures())
    choice.selectors[1].options.push_back(error.title);
  for (const analysis::Quantity& cost : analysis::list_cost_measures(cells)) {
    choice.selectors[2].options.push_back(cost.title);
    choice.selectors[2].costs.push_back(cost.id);
  }
  for (const analysis::TradeScope& scope : scopes) {
    choice.selectors[0].options.push_back(scope.title);
    for (std::size_t error = 0; error < analysis::kErrorMeasures; ++error) {
      for (std::size_t cost = 0; cost < scope.costs.size(); ++cost) {
        const analysis::TradeFront front = analysis::make_trade_front(scope, error, cost);
        choice.charts.push_back(FrontChart(scope, front, cells, gl).make());
      }
    }
  }
  return choice;
}

document::ChartChoice make_width_choice(const std::vector<analysis::CostChart>& charts,
                                        const std::vector<std::string>& filters, const records::GlRecord& gl) {
  document::ChartChoice choice{
      "width", {{"where", {}}, {"light", {"static: lookup", "moving: map, prefilter, lookup"}}}, {}};
  for (const analysis::CostChart& chart : charts) {
    choice.selectors[0].options.push_back(chart.title);
    for (const std::size_t light : {analysis::kStaticCost, analysis::kMovingCost})
      choice.charts.push_back(WidthChart(chart, light, gl).make(filters));
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

namespace {

using Blocks = std::vector<document::Block>;

constexpr const char* kFrontsNote =
    "Lower left is better. Line: the Pareto front of a class of width. Hollow: tied. Pale: beaten. Ringed: the "
    "answers.";
constexpr const char* kLargeNote = "The run has more than {} cells: beaten ones are left out of these charts.";
constexpr const char* kMapsNote =
    "A map that is fitted to the scene (tight, sphere) serves every camera, and can be kept while light and casters "
    "stand still; every other fit follows a camera, and is drawn anew whenever it moves.";

/// How fronts are read: what dominated and tied mean, what the intervals are, how scenes are combined, and what each of
/// `costs` is.
std::vector<std::string> explain_fronts(const std::vector<analysis::Quantity>& costs) {
  std::vector<std::string> sentences = {
      fmt::format(
          "Only filters whose kernels are about equally wide are compared: a wider kernel makes a softer shadow, "
          "and is no worse filter. Kernel width is the standard deviation along an axis, in texels; each "
          "class has a front of its own: {}.",
          filters::describe_classes()),
      "A cell of the front beats another of its class, which is then dominated, where it costs no more, its error is "
      "not clearly larger, and one of the two is clearly less. A cell is tied with one of the front where neither is "
      "clearly less. Clearly: errors where the 95 % interval of their difference, which is taken group by group of "
      "the phases that all cells share, does not hold 0; times whose 95 % intervals do not overlap; everything else "
      "where the numbers differ. Of several that beat a cell, the cheapest is named."};
  const auto explain = [&](const analysis::Quantity& measure) {
    sentences.push_back(
        fmt::format("{}: {}. All scenes together: {}.", measure.title, measure.meaning, measure.over_scenes));
  };
  std::ranges::for_each(analysis::list_error_measures(), explain);
  std::ranges::for_each(costs, explain);
  return sentences;
}

void add_fronts(Blocks& blocks, const records::RunRecord& run, const std::vector<records::CellRecord>& cells,
                const Trade& trade) {
  blocks.emplace_back(document::Paragraph{kFrontsNote, true});
  if (cells.size() > kMostCellsInDetail)
    blocks.emplace_back(document::Paragraph{fmt::format(kLargeNote, kMostCellsInDetail), true});
  blocks.emplace_back(make_front_choice(trade.scopes, cells, run.gl));
  blocks.emplace_back(document::Details{"How to read the fronts",
                                        {document::Sentences{{}, explain_fronts(trade.scopes.front().costs)}}});
}

void add_charts(Blocks& blocks, const char* heading, document::ChartChoice charts, const char* note) {
  if (charts.charts.empty()) return;
  document::Details details{heading, {std::move(charts)}};
  if (note) details.blocks.emplace_back(document::Paragraph{note, true});
  blocks.emplace_back(std::move(details));
}

}  // namespace

std::optional<Trade> make_trade(const std::vector<records::CellRecord>& cells) {
  Trade trade;
  trade.scopes = analysis::make_trade_scopes(cells);
  trade.has_fronts = analysis::has_trade(trade.scopes);
  trade.map_families = analysis::list_map_families(analysis::point_to(cells));
  if (!trade.has_fronts && trade.map_families.empty()) return std::nullopt;
  if (trade.has_fronts) trade.width_charts = analysis::make_width_charts(trade.scopes);
  return trade;
}

document::Section make_trade_section(const records::RunRecord& run, const std::vector<records::CellRecord>& cells,
                                     const Trade& trade) {
  document::Section section{"trade", "The trade", {}};
  const std::vector<std::string> filters = analysis::list_filters(cells);
  if (trade.has_fronts) add_fronts(section.blocks, run, cells, trade);
  add_charts(section.blocks, "Cost over the kernel width", make_width_choice(trade.width_charts, filters, run.gl),
             nullptr);
  add_charts(section.blocks, "Error of maps of several fits, over their bytes",
             make_map_choice(trade.map_families, analysis::make_map_measure(analysis::point_to(cells)), run.gl),
             kMapsNote);
  return section;
}

}  // namespace shadowbench::pages
