#include "report/analysis/trade.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <span>

#include "filters/kernel.h"
#include "report/analysis/cells.h"
#include "report/files/file_name.h"
#include "report/records/cell_key.h"
#include "report/records/format.h"
#include "report/records/json_values.h"

namespace shadowbench::analysis {
namespace {

constexpr std::size_t kFewestCells = 3;

// Reads cells' errors and costs; those of several scenes are combined.
class CellReader {
 public:
  explicit CellReader(const std::vector<records::CellRecord>& cells) : costs_(list_cost_measures(cells)) {}

  const std::vector<Quantity>& costs() const { return costs_; }

  TradeConfiguration read(const CellList& cells) const {
    const records::CellRecord& first = *cells.front();
    const bool is_as_wide = std::ranges::all_of(
        cells, [&](const auto* cell) { return cell->kernel.sigma_texels == first.kernel.sigma_texels; });
    TradeConfiguration result{
        first.filter, records::named_params(first), first.map_size, {}, find_class(first), {}, cells, {}, {}};
    if (is_as_wide) result.sigma_texels = first.kernel.sigma_texels;
    for (std::size_t i = 0; i < kErrorMeasures; ++i)
      result.errors[i] = combine(cells, read_error, list_error_measures()[i]);
    for (const Quantity& cost : costs_) result.costs.push_back(combine(cells, read_cost, cost));
    return result;
  }

 private:
  std::vector<Quantity> costs_;

  static Measured combine(const CellList& cells, Measured (*read_one)(const records::CellRecord&, const Quantity&),
                          const Quantity& measure) {
    std::vector<Estimate> estimates;
    for (const records::CellRecord* cell : cells) {
      const bool is_suspect = cell->status == records::CellStatus::kSuspect;
      Measured one = is_suspect ? Measured{std::nullopt, "suspect: see the warnings"} : read_one(*cell, measure);
      if (!one.estimate || cells.size() == 1) return one;
      estimates.push_back(*one.estimate);
    }
    return {measure.combine(estimates), {}};
  }
};

TradeScope make_place_scope(const CellList& cells, const CellReader& reader) {
  const records::CellRecord& first = *cells.front();
  TradeScope scope;
  scope.scene = first.scene;
  scope.view = first.view;
  scope.title = fmt::format("{} · view {} · {} × {}", first.scene, first.view, first.width, first.height);
  scope.id = files::make_file_stem(fmt::format("{}.{}.{}x{}", first.scene, first.view, first.width, first.height));
  for (const CellList& own : pivot(cells, {})) scope.configurations.push_back(reader.read({own.front()}));
  return scope;
}

TradeScope make_joint_scope(const CellList& cells, const CellReader& reader) {
  const records::CellRecord& first = *cells.front();
  std::set<std::string> names;
  for (const records::CellRecord* cell : cells) names.insert(cell->scene);
  const std::size_t places = list_places(cells).size(), scenes = names.size();
  TradeScope scope;
  scope.title = fmt::format("{} · {} × {}",
                            places == scenes ? fmt::format("all {} scenes", scenes)
                                             : fmt::format("all {} views of {} scenes", places, scenes),
                            first.width, first.height);
  scope.id = fmt::format("all.{}x{}", first.width, first.height);
  for (const CellList& own : pivot(cells, {"scene", "view"}))
    if (own.size() == places)
      scope.configurations.push_back(reader.read(own));
    else
      ++scope.incomplete;
  return scope;
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

// The parameters of a filter that say no more than its width: each of their values has one width and each width one
// value.
std::set<std::string> find_width_params(const std::vector<TradeConfiguration>& configurations,
                                        const std::vector<std::size_t>& chosen, const std::string& filter) {
  std::map<std::string, std::set<std::pair<double, std::string>>> pairs;
  std::map<std::string, std::set<std::string>> values;
  std::set<double> widths;
  for (const std::size_t i : chosen) {
    if (configurations[i].filter != filter || !configurations[i].sigma_texels) continue;
    widths.insert(*configurations[i].sigma_texels);
    for (const auto& [name, value] : configurations[i].params) {
      const std::string text = records::describe_params({{name, value}});
      pairs[name].insert({*configurations[i].sigma_texels, text});
      values[name].insert(text);
    }
  }
  std::set<std::string> names;
  for (const auto& [name, found] : pairs)
    if (found.size() == widths.size() && values[name].size() == widths.size() && widths.size() > 1) names.insert(name);
  return names;
}

// A series' parameters are named where its filter has several.
void label_series(std::vector<WidthSeries>& all) {
  std::map<std::string, int> counts;
  for (const WidthSeries& series : all) ++counts[series.filter];
  for (WidthSeries& series : all) {
    const bool told = counts[series.filter] > 1 && !series.label.empty();
    series.label = told ? fmt::format("{} ({})", series.filter, series.label) : series.filter;
  }
}

// By what differs among them, as records::CellNames does.
void label_configurations(std::vector<TradeConfiguration>& configurations) {
  CellList firsts;
  for (const TradeConfiguration& each : configurations) firsts.push_back(each.cells.front());
  const records::CellNames names(firsts);
  for (TradeConfiguration& each : configurations) each.label = names.name(*each.cells.front());
}

}  // namespace

std::vector<TradeScope> make_trade_scopes(const std::vector<records::CellRecord>& cells) {
  const CellList all = point_to(cells);
  const CellReader reader(cells);
  std::vector<TradeScope> scopes;
  const std::vector<LeftOutPlace> left_out = list_left_out(all);
  CellList counted = all;
  std::erase_if(counted, [&](const auto* cell) { return is_left_out(*cell, left_out); });
  for (const CellList& picture : pivot(counted, {"filter", "params", "map_size", "scene", "view"}))
    if (list_places(picture).size() > 1) scopes.push_back(make_joint_scope(picture, reader));
  for (const CellList& place : pivot(all, {"filter", "params", "map_size"}))
    scopes.push_back(make_place_scope(place, reader));
  std::set<std::string> fits;
  for (const records::CellRecord& cell : cells) fits.insert(cell.fit);
  for (TradeScope& scope : scopes) {
    const records::CellRecord* first = scope.configurations.empty() ? nullptr : scope.configurations[0].cells[0];
    scope.width = first ? first->width : 0;
    scope.height = first ? first->height : 0;
    scope.costs = reader.costs();
    if (first && fits.size() > 1) scope.title += " · " + records::name_fit(first->fit, fits);
    label_configurations(scope.configurations);
  }
  std::erase_if(scopes, [](const TradeScope& scope) { return scope.configurations.empty(); });
  make_unique(scopes);
  return scopes;
}

std::vector<WidthSeries> list_width_series(const std::vector<TradeConfiguration>& configurations,
                                           const std::vector<std::size_t>& chosen) {
  std::vector<WidthSeries> all;
  std::map<std::string, std::size_t> places;
  std::map<std::string, std::set<std::string>> names;
  for (const std::size_t i : chosen) {
    const TradeConfiguration& each = configurations[i];
    if (!each.sigma_texels) continue;
    if (!names.contains(each.filter)) names[each.filter] = find_width_params(configurations, chosen, each.filter);
    records::ParamMap params = each.params;
    std::erase_if(params, [&](const auto& param) { return names[each.filter].contains(param.first); });
    const std::string key =
        fmt::format("{} {} {}", each.filter, each.map_size, records::dump_line(records::value_json(params)));
    const auto [place, is_new] = places.emplace(key, all.size());
    if (is_new) all.push_back({each.filter, records::describe_params(params), {}});
    all[place->second].configurations.push_back(i);
  }
  for (WidthSeries& series : all)
    std::ranges::stable_sort(series.configurations, {}, [&](std::size_t i) { return *configurations[i].sigma_texels; });
  label_series(all);
  return all;
}

TradeFront make_trade_front(const TradeScope& scope, std::size_t error, std::size_t cost) {
  TradeFront front;
  front.error = error;
  front.cost = cost;
  for (std::size_t i = 0; i < scope.configurations.size(); ++i) {
    const Measured& e = scope.configurations[i].errors[error];
    const Measured& c = scope.configurations[i].costs[cost];
    if (!e.estimate || !c.estimate) {
      ++front.left_out[e.estimate ? c.absent : e.absent];
      continue;
    }
    front.configurations.push_back(i);
    front.points.push_back({*e.estimate, *c.estimate, scope.configurations[i].width_class});
  }
  front.placements = find_front(front.points);
  front.members = list_members(front.points, front.placements);
  return front;
}

bool has_trade(const std::vector<TradeScope>& scopes) {
  const auto has_one = [](const auto& measured) {
    return std::any_of(
        measured.begin(), measured.end(), [](const Measured& each) { return each.estimate.has_value(); });
  };
  return std::any_of(scopes.begin(), scopes.end(), [&](const TradeScope& scope) {
    const auto count =
        std::count_if(scope.configurations.begin(), scope.configurations.end(),
                      [&](const TradeConfiguration& each) { return has_one(each.errors) && has_one(each.costs); });
    return static_cast<std::size_t>(count) >= kFewestCells;
  });
}

std::vector<std::string> list_filters(const std::vector<records::CellRecord>& cells) {
  std::vector<std::string> filters;
  for (const records::CellRecord& cell : cells)
    if (std::find(filters.begin(), filters.end(), cell.filter) == filters.end()) filters.push_back(cell.filter);
  return filters;
}

namespace {

CostCurve make_width_curve(const TradeScope& scope, const WidthSeries& series) {
  const records::CellRecord& last = *scope.configurations[series.configurations.back()].cells.front();
  CostCurve curve{series.filter, series.label, {}, last.cost.prefilter_texels.value_or(0) > 0};
  for (const std::size_t i : series.configurations) {
    const TradeConfiguration& each = scope.configurations[i];
    curve.points.push_back(
        {*each.sigma_texels, {*each.costs[kMovingCost].estimate, *each.costs[kStaticCost].estimate}});
  }
  return curve;
}

std::vector<CostCurve> make_width_curves(const TradeScope& scope, int map_size) {
  std::vector<std::size_t> timed;
  for (std::size_t i = 0; i < scope.configurations.size(); ++i) {
    const TradeConfiguration& each = scope.configurations[i];
    if (each.map_size == map_size && each.costs[kStaticCost].estimate && each.costs[kMovingCost].estimate)
      timed.push_back(i);
  }
  std::vector<CostCurve> curves;
  for (const WidthSeries& series : list_width_series(scope.configurations, timed))
    curves.push_back(make_width_curve(scope, series));
  return curves;
}

bool has_several_fits(std::span<const MapPoint> maps) {
  return std::ranges::any_of(
      maps, [&](const MapPoint& map) { return map.name != maps.front().name; });
}

/// The maps that all families have.
MapFamily join_families(const std::vector<MapFamily>& families, const Quantity& cost) {
  std::map<std::pair<std::string, int>, std::vector<MapPoint>> by_map;
  for (const MapFamily& family : families)
    for (const MapPoint& each : family.maps) by_map[{each.name, each.size}].push_back(each);
  MapFamily joined{"all filters", {}};
  for (const auto& [map, points] : by_map) {
    if (points.size() < families.size()) continue;
    MapPoint& all = joined.maps.emplace_back(points.front());
    std::vector<Estimate> costs, errors;
    for (const MapPoint& each : points) {
      all.bytes = std::min(all.bytes, each.bytes);
      all.seam = std::max(all.seam, each.seam);
      costs.push_back(each.cost);
      errors.push_back(each.rmse);
    }
    all.cost = cost.combine(costs);
    all.rmse = list_error_measures().front().combine(errors);
  }
  std::ranges::stable_sort(joined.maps, {}, &MapPoint::bytes);
  return joined;
}

}  // namespace

std::vector<double> CostChart::widths() const {
  std::set<double> widths;
  for (const CostCurve& curve : curves)
    for (const CurvePoint& point : curve.points) widths.insert(point.sigma_texels);
  return {widths.begin(), widths.end()};
}

std::vector<CostChart> make_width_charts(const std::vector<TradeScope>& scopes) {
  std::vector<CostChart> charts;
  for (const TradeScope& scope : scopes) {
    if (scope.scene.empty()) continue;
    std::set<int> map_sizes;
    for (const TradeConfiguration& each : scope.configurations) map_sizes.insert(each.map_size);
    for (const int map_size : map_sizes) {
      CostChart chart{scope.id, fmt::format("{} · map {}", scope.title, map_size), map_size, scope.costs,
                      make_width_curves(scope, map_size)};
      const auto has_several = [](const CostCurve& curve) { return curve.points.size() > 1; };
      if (std::ranges::any_of(chart.curves, has_several)) charts.push_back(std::move(chart));
    }
  }
  return charts;
}

Quantity make_map_measure(const std::vector<const records::CellRecord*>& cells) {
  return make_frame_measure(CostKind::kTime, LightMotion::kMoving, cells);
}

std::vector<MapFamily> list_map_families(const std::vector<const records::CellRecord*>& cells) {
  std::set<std::string> fits;
  for (const records::CellRecord* cell : cells) fits.insert(cell->fit);
  if (fits.size() < 2) return {};
  const Quantity cost = make_map_measure(cells);
  const auto places = list_places(cells);
  const std::vector<CellList> filters = pivot(cells, {"scene", "view", "fit", "map_size"});
  std::vector<records::CellRecord> plain;  // without their maps, which are in no name
  for (const CellList& each : filters) {
    plain.push_back(*each.front());
    plain.back().fit.clear();
    plain.back().map_size = 0;
  }
  const records::CellNames names(point_to(plain));
  std::vector<MapFamily> families;
  for (std::size_t i = 0; i < filters.size(); ++i) {
    std::vector<MapFamily> own;
    for (const Place& place : places)
      own.push_back({fmt::format("{} on {}", names.name(plain[i]), describe_place(place, places)), {}});
    for (const records::CellRecord* each : filters[i]) {
      const records::CellRecord& cell = *each;
      const Measured paid = read_cost(cell, cost), rmse = read_error(cell, list_error_measures()[0]);
      if (cell.status != records::CellStatus::kOk || !paid.estimate || !rmse.estimate || !cell.cost.map_bytes) continue;
      own[find_place(places, cell)].maps.push_back(
          {cell.fit.substr(0, cell.fit.find_first_of(": ")), records::name_fit(cell.fit, fits), cell.map_size,
           static_cast<double>(*cell.cost.map_bytes), *paid.estimate, *rmse.estimate, cell.artefact.seam});
    }
    for (MapFamily& family : own) {
      std::ranges::stable_sort(family.maps, {}, &MapPoint::bytes);
      if (has_several_fits(family.maps)) families.push_back(std::move(family));
    }
  }
  if (families.size() > 1)
    if (MapFamily joined = join_families(families, cost); has_several_fits(joined.maps))
      families.insert(families.begin(), std::move(joined));
  return families;
}

}  // namespace shadowbench::analysis
