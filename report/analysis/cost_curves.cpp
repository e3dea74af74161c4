#include "report/analysis/cost_curves.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "report/analysis/configuration.h"
#include "report/records/cell_names.h"

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

bool has_several_fits(const MapFamily& family) {
  return std::ranges::any_of(
      family.maps, [&](const MapPoint& map) { return map.fit != family.maps.front().fit; });
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

Measure make_map_measure(const std::vector<records::CellRecord>& cells) {
  return make_frame_measure(CostKind::kTime, LightMotion::kMoving, point_to(cells));
}

std::vector<MapFamily> list_map_families(const std::vector<records::CellRecord>& cells) {
  std::set<std::string> fits;
  for (const records::CellRecord& cell : cells) fits.insert(cell.fit);
  if (fits.size() < 2) return {};
  std::vector<records::CellRecord> plain = cells;  // without their maps: one configuration is a family
  for (records::CellRecord& cell : plain) {
    cell.fit.clear();
    cell.map_size = 0;
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
      const records::CellRecord& cell = cells[static_cast<std::size_t>(each - plain.data())];
      const Measured paid = read_cost(cell, cost), rmse = read_error(cell, list_error_measures()[0]);
      if (cell.status != records::CellStatus::kOk || !paid.estimate || !rmse.estimate) continue;
      own[find_place(places, cell)].maps.push_back(
          {records::name_fit(cell.fit, fits), cell.map_size, *paid.estimate, *rmse.estimate});
    }
    for (MapFamily& family : own) {
      std::ranges::stable_sort(family.maps, {}, &MapPoint::size);
      if (has_several_fits(family)) families.push_back(std::move(family));
    }
  }
  return families;
}

}  // namespace shadowbench::analysis
