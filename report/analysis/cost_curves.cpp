#include "report/analysis/cost_curves.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>
#include <set>
#include <span>

#include "report/analysis/configuration.h"
#include "report/records/cell_names.h"
#include "report/records/format.h"

namespace shadowbench::analysis {
namespace {

CostCurve make_width_curve(const TradeScope& scope, const WidthSeries& series,
                           const std::vector<records::CellRecord>& cells) {
  const records::CellRecord& last = cells[scope.configurations[series.configurations.back()].cells.front()];
  CostCurve curve{series.filter, series.label, {}, last.cost.prefilter_texels.value_or(0) > 0};
  for (const std::size_t i : series.configurations) {
    const TradeConfiguration& each = scope.configurations[i];
    curve.points.push_back(
        {*each.sigma_texels, {*each.costs[kMovingCost].estimate, *each.costs[kStaticCost].estimate}});
  }
  return curve;
}

std::vector<CostCurve> make_width_curves(const TradeScope& scope, int map_size,
                                         const std::vector<records::CellRecord>& cells) {
  std::vector<std::size_t> timed;
  for (std::size_t i = 0; i < scope.configurations.size(); ++i) {
    const TradeConfiguration& each = scope.configurations[i];
    if (each.map_size == map_size && each.costs[kStaticCost].estimate && each.costs[kMovingCost].estimate)
      timed.push_back(i);
  }
  std::vector<CostCurve> curves;
  for (const WidthSeries& series : list_width_series(scope.configurations, timed))
    curves.push_back(make_width_curve(scope, series, cells));
  return curves;
}

bool has_several_fits(std::span<const MapPoint> maps) {
  return std::ranges::any_of(
      maps, [&](const MapPoint& map) { return map.name != maps.front().name; });
}

/// Layers that share the bytes of one map are rounded down to whole texels.
constexpr double kEqualBytes = 0.99;

/// The maps that all families have.
MapFamily join_families(const std::vector<MapFamily>& families, const Measure& cost) {
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

/// The least error of every kind of fit but that of `best`, ascending.
std::string list_other_fits(std::span<const MapPoint> maps, const MapPoint& best) {
  std::vector<MapPoint> others(maps.begin(), maps.end());
  std::ranges::sort(others, {}, [](const MapPoint& each) { return each.rmse.value; });
  std::set<std::string> kinds = {best.kind};
  std::vector<std::string> texts;
  for (const MapPoint& each : others)
    if (kinds.insert(each.kind).second)
      texts.push_back(fmt::format("{} by {}", records::format_number(each.rmse.value), each.name));
  return texts.empty() ? "" : fmt::format(" ({})", fmt::join(texts, "; "));
}

/// Of those whose error is not clearly above the least, the one with the least seam; one without any goes first.
const MapPoint& choose_map(std::span<const MapPoint> maps) {
  const MapPoint& least = *std::ranges::min_element(maps, {}, [](const MapPoint& each) { return each.rmse.value; });
  const MapPoint* best = &least;
  for (const MapPoint& each : maps)
    if (each.seam < best->seam && !is_clearly_less_error(least.rmse, each.rmse)) best = &each;
  return *best;
}

}  // namespace

std::vector<double> CostChart::widths() const {
  std::set<double> widths;
  for (const CostCurve& curve : curves)
    for (const CurvePoint& point : curve.points) widths.insert(point.sigma_texels);
  return {widths.begin(), widths.end()};
}

std::vector<CostChart> make_width_charts(const std::vector<records::CellRecord>& cells,
                                         const std::vector<TradeScope>& scopes) {
  std::vector<CostChart> charts;
  for (const TradeScope& scope : scopes) {
    if (scope.scene.empty()) continue;
    std::set<int> map_sizes;
    for (const TradeConfiguration& each : scope.configurations) map_sizes.insert(each.map_size);
    for (const int map_size : map_sizes) {
      CostChart chart{scope.id, fmt::format("{} · map {}", scope.title, map_size), map_size, scope.costs,
                      make_width_curves(scope, map_size, cells)};
      const auto has_several = [](const CostCurve& curve) { return curve.points.size() > 1; };
      if (std::ranges::any_of(chart.curves, has_several)) charts.push_back(std::move(chart));
    }
  }
  return charts;
}

Measure make_map_measure(const std::vector<const records::CellRecord*>& cells) {
  return make_frame_measure(CostKind::kTime, LightMotion::kMoving, cells);
}

std::vector<MapFamily> list_map_families(const std::vector<const records::CellRecord*>& cells) {
  std::set<std::string> fits;
  for (const records::CellRecord* cell : cells) fits.insert(cell->fit);
  if (fits.size() < 2) return {};
  std::vector<records::CellRecord> plain;  // without their maps: one configuration is a family
  for (const records::CellRecord* cell : cells) {
    plain.push_back(*cell);
    plain.back().fit.clear();
    plain.back().map_size = 0;
  }
  const Measure cost = make_map_measure(cells);
  const auto all = point_to(plain);
  const auto places = list_places(all);
  std::vector<MapFamily> families;
  for (const Configuration& configuration : list_configurations(all)) {
    std::vector<MapFamily> own;
    for (const Place& place : places)
      own.push_back({fmt::format("{} on {}", configuration.name, describe_place(place, places)), {}});
    for (const records::CellRecord* each : configuration.cells) {
      const records::CellRecord& cell = *cells[static_cast<std::size_t>(each - plain.data())];
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

std::string describe_best_map(const std::vector<MapFamily>& families) {
  if (families.empty()) return {};
  const MapFamily& family = families.front();
  std::string text;
  for (std::span<const MapPoint> rest = family.maps; !rest.empty();) {
    const double bytes = rest.back().bytes;
    const auto first =
        std::ranges::find_if(rest, [&](const MapPoint& each) { return each.bytes > kEqualBytes * bytes; });
    const std::span<const MapPoint> maps(first, rest.end());
    rest = {rest.begin(), first};
    if (!has_several_fits(maps)) continue;
    const MapPoint& best = choose_map(maps);
    const auto ties = std::ranges::count_if(
        maps, [&](const MapPoint& each) { return &each != &best && !is_clearly_less_error(best.rmse, each.rmse); });
    text += fmt::format("{} {}: {}, {} texels a side, RMSE {}", text.empty() ? "Best map at" : "; at",
                        records::format_bytes(bytes), best.name, best.size, records::format_number(best.rmse.value));
    if (best.seam) text += ", seam " + records::format_number(best.seam);
    if (ties > 0) text += fmt::format(", tied with {} other{}", ties, ties > 1 ? "s" : "");
    if (rest.size() + maps.size() == family.maps.size()) text += list_other_fits(maps, best);
  }
  return text.empty() ? text : text + ".";
}

}  // namespace shadowbench::analysis
