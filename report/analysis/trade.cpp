#include "report/analysis/trade.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <numeric>
#include <set>
#include <tuple>
#include <utility>

#include "base/files.h"
#include "report/records/cell_key.h"
#include "report/records/format.h"

namespace shadowbench::analysis {
namespace {

constexpr std::size_t kFewestCells = 3;

TradeScope make_place_scope(const CellList& cells) {
  const records::CellRecord& first = *cells.front();
  return {make_file_stem(fmt::format("{}.{}.{}x{}", first.scene, first.view, first.width, first.height)),
          fmt::format("{} · view {} · {} × {}", first.scene, first.view, first.width, first.height), false,
          list_configurations(cells)};
}

TradeScope make_joint_scope(const CellList& cells) {
  const records::CellRecord& first = *cells.front();
  std::set<std::string> names;
  for (const records::CellRecord* cell : cells) names.insert(cell->scene);
  const std::size_t places = list_places(cells).size(), scenes = names.size();
  const std::string title = places == scenes ? fmt::format("all {} scenes", scenes)
                                             : fmt::format("all {} views of {} scenes", places, scenes);
  CellList everywhere;
  for (const CellList& own : pivot(cells, {"scene", "view"}))
    if (own.size() == places) everywhere.insert(everywhere.end(), own.begin(), own.end());
  return {fmt::format("all.{}x{}", first.width, first.height),
          fmt::format("{} · {} × {}", title, first.width, first.height), true, list_configurations(everywhere)};
}

// Scopes that differ in another setting than those that their names have are numbered.
void make_unique(std::vector<TradeScope>& scopes) {
  std::map<std::string, int> ids, titles;
  for (TradeScope& scope : scopes) {
    if (const int number = ++ids[scope.id]; number > 1) scope.id += fmt::format(".{}", number);
    if (const int number = ++titles[scope.title]; number > 1)
      scope.title += fmt::format(" · other settings ({})", number);
  }
}

}  // namespace

std::vector<TradeScope> make_trade_scopes(const std::vector<records::CellRecord>& cells) {
  const CellList all = point_to(cells);
  std::vector<TradeScope> scopes;
  const std::vector<LeftOutPlace> left_out = list_left_out(all);
  CellList counted = all;
  std::erase_if(counted, [&](const auto* cell) { return is_left_out(*cell, left_out); });
  for (const CellList& picture : pivot(counted, {"filter", "params", "map_size", "fit", "scene", "view"}))
    if (list_places(picture).size() > 1) scopes.push_back(make_joint_scope(picture));
  for (const CellList& place : pivot(all, {"filter", "params", "map_size", "fit"}))
    scopes.push_back(make_place_scope(place));
  std::erase_if(scopes, [](const TradeScope& scope) { return scope.configurations.empty(); });
  make_unique(scopes);
  return scopes;
}

Measured measure(const Configuration& configuration, const Quantity& quantity) {
  std::vector<Estimate> estimates;
  for (const records::CellRecord* cell : configuration.cells) {
    const bool is_suspect = cell->status == records::CellStatus::kSuspect;
    Measured one = is_suspect      ? Measured{std::nullopt, "suspect: see the warnings"}
                   : quantity.cost ? read_cost(*cell, quantity)
                                   : read_error(*cell, quantity);
    if (!one.estimate || configuration.cells.size() == 1) return one;
    estimates.push_back(*one.estimate);
  }
  return {quantity.combine(estimates), {}};
}

std::vector<FrontPoint> list_points(const TradeScope& scope, const Quantity& error, const Quantity& cost) {
  std::vector<FrontPoint> points;
  for (const Configuration& each : scope.configurations) {
    const Measured wrong = measure(each, error), paid = measure(each, cost);
    if (wrong.estimate && paid.estimate)
      points.push_back({&each, *wrong.estimate, *paid.estimate, find_class(*each.cells.front())});
  }
  return points;
}

std::vector<std::size_t> find_front(const std::vector<FrontPoint>& points) {
  std::vector<std::size_t> order(points.size()), leaders(points.size()), members;
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(order, {},
                           [&](std::size_t i) { return std::tuple(points[i].cost.value, points[i].error.value); });
  for (const std::size_t i : order) {
    const auto leader = std::ranges::find_if(members, [&](std::size_t member) {
      return points[member].group == points[i].group && points[member].error.value <= points[i].error.value;
    });
    leaders[i] = leader == members.end() ? i : *leader;
    if (leaders[i] == i && points[i].group) members.push_back(i);
  }
  return leaders;
}

bool is_tied(const FrontPoint& a, const FrontPoint& b) {
  return a.group && a.group == b.group && !is_clearly_less_error(a.error, b.error) &&
         !is_clearly_less_error(b.error, a.error) && !is_clearly_less_cost(a.cost, b.cost) &&
         !is_clearly_less_cost(b.cost, a.cost);
}

bool has_trade(const std::vector<TradeScope>& scopes, const std::vector<Quantity>& costs) {
  const auto has_both = [&](const Configuration& each) {
    const auto has = [&](const Quantity& quantity) { return measure(each, quantity).estimate.has_value(); };
    return std::ranges::any_of(list_error_measures(), has) && std::ranges::any_of(costs, has);
  };
  return std::ranges::any_of(scopes, [&](const TradeScope& scope) {
    return static_cast<std::size_t>(std::ranges::count_if(scope.configurations, has_both)) >= kFewestCells;
  });
}

std::vector<std::string> list_filters(const std::vector<records::CellRecord>& cells) {
  std::vector<std::string> filters;
  for (const records::CellRecord& cell : cells)
    if (std::find(filters.begin(), filters.end(), cell.filter) == filters.end()) filters.push_back(cell.filter);
  return filters;
}

namespace {

/// A configuration whose width and costs are known.
struct Timed {
  const records::CellRecord* cell = nullptr;
  CurvePoint point;
  records::ParamMap params;  ///< as they were asked for
};

// The parameters of a filter that say no more than its width: each of their values has one width and each width one
// value.
std::set<std::string> find_width_params(const std::vector<Timed>& all, const std::string& filter) {
  std::map<std::string, std::set<std::pair<double, std::string>>> pairs;
  std::map<std::string, std::set<std::string>> values;
  std::set<double> widths;
  for (const Timed& each : all) {
    if (each.cell->filter != filter) continue;
    widths.insert(each.point.sigma_texels);
    for (const auto& [name, value] : each.params) {
      const std::string text = records::describe_params({{name, value}});
      pairs[name].insert({each.point.sigma_texels, text});
      values[name].insert(text);
    }
  }
  std::set<std::string> names;
  for (const auto& [name, found] : pairs)
    if (found.size() == widths.size() && values[name].size() == widths.size() && widths.size() > 1) names.insert(name);
  return names;
}

std::vector<CostCurve> join_curves(const std::vector<Timed>& all) {
  std::vector<CostCurve> curves;
  for (const Timed& each : all) {
    records::ParamMap params = each.params;
    const std::set<std::string> of_width = find_width_params(all, each.cell->filter);
    std::erase_if(params, [&](const auto& param) { return of_width.contains(param.first); });
    const CostCurve own{each.cell->filter, records::describe_params(params), {}};
    auto curve = std::ranges::find_if(
        curves, [&](const CostCurve& known) { return known.filter == own.filter && known.label == own.label; });
    if (curve == curves.end()) curve = curves.insert(curve, own);
    curve->points.push_back(each.point);
    curve->prefiltered = curve->prefiltered || each.cell->cost.prefilter_texels.value_or(0) > 0;
  }
  for (CostCurve& curve : curves) {
    std::ranges::stable_sort(curve.points, {}, &CurvePoint::sigma_texels);
    const bool is_told = std::ranges::count(curves, curve.filter, &CostCurve::filter) > 1 && !curve.label.empty();
    curve.label = is_told ? fmt::format("{} ({})", curve.filter, curve.label) : curve.filter;
  }
  return curves;
}

/// A size and a fit.
using Map = std::pair<int, std::string>;

Map map_of(const Configuration& configuration) {
  const records::CellRecord& cell = *configuration.cells.front();
  return {cell.map_size, cell.fit};
}

std::vector<CostCurve> make_width_curves(const TradeScope& scope, const std::vector<Quantity>& costs, const Map& map) {
  std::vector<Timed> timed;
  for (const Configuration& each : scope.configurations) {
    const records::CellRecord& cell = *each.cells.front();
    const Measured moving = measure(each, costs[kMovingCost]), still = measure(each, costs[kStaticCost]);
    if (map_of(each) == map && cell.kernel.sigma_texels && moving.estimate && still.estimate)
      timed.push_back(
          {&cell, {*cell.kernel.sigma_texels, {*moving.estimate, *still.estimate}}, records::named_params(cell)});
  }
  return join_curves(timed);
}

}  // namespace

std::vector<double> CostChart::widths() const {
  std::set<double> widths;
  for (const CostCurve& curve : curves)
    for (const CurvePoint& point : curve.points) widths.insert(point.sigma_texels);
  return {widths.begin(), widths.end()};
}

std::vector<CostChart> make_width_charts(const std::vector<TradeScope>& scopes, const std::vector<Quantity>& costs) {
  std::vector<CostChart> charts;
  for (const TradeScope& scope : scopes) {
    if (scope.is_joint) continue;
    std::set<Map> maps;
    std::set<std::string> fits;
    for (const Configuration& each : scope.configurations) {
      maps.insert(map_of(each));
      fits.insert(map_of(each).second);
    }
    for (const auto& [size, fit] : maps) {
      CostChart chart{fmt::format("{}.map{}", scope.id, size), fmt::format("{} · map {}", scope.title, size),
                      make_width_curves(scope, costs, {size, fit})};
      if (fits.size() > 1) {
        chart.id += "." + records::make_fit_stem(fit, fits);
        chart.title += ", " + records::name_fit(fit, fits);
      }
      const auto has_several = [](const CostCurve& curve) { return curve.points.size() > 1; };
      if (std::ranges::any_of(chart.curves, has_several)) charts.push_back(std::move(chart));
    }
  }
  return charts;
}

}  // namespace shadowbench::analysis
