#include "report/analysis/cost_curves.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <set>

namespace shadowbench::analysis {
namespace {

// Widths that differ by less than this share are taken for the same.
constexpr double kSameWidth = 0.01;

bool are_same(double a, double b) { return std::abs(a - b) <= kSameWidth * std::max(a, b); }

// Whether a filter reads the map at many places of its kernel.
bool has_many_taps(const records::CellRecord& cell) {
  return cell.cost.fetches.value_or(0.0) > 1.0 && cell.kernel_radius_texels.value_or(0.0) > 0.0;
}

CostCurve make_width_curve(const TradeScope& scope, const WidthSeries& series,
                           const std::vector<records::CellRecord>& cells) {
  const records::CellRecord& last = cells[scope.configurations[series.configurations.back()].cells.front()];
  CostCurve curve{series.filter, series.label, {}, last.cost.prefilter_texels.value_or(0) > 0};
  curve.many_taps = !curve.prefiltered && has_many_taps(last);
  for (const std::size_t i : series.configurations) {
    const TradeConfiguration& each = scope.configurations[i];
    curve.points.push_back(
        {*each.sigma_texels, {*each.costs[kMovingCost].estimate, *each.costs[kStaticCost].estimate}, {}});
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

Estimate read_spread(const records::Quartiles& time) { return {time.median, time.q1, time.q3}; }

Estimate scale(const records::Ratio& ratio, const records::Quartiles& reference) {
  return {ratio.median * reference.median, ratio.ci95.low * reference.median, ratio.ci95.high * reference.median};
}

CurvePoint make_light_point(const records::LightCountRecord& own, const records::CellRecord* reference) {
  CurvePoint point{static_cast<double>(own.count), {}, {read_spread(own.moving_ms), read_spread(own.static_ms)}};
  point.cost = point.spread;
  if (!reference) return point;
  const auto under = std::ranges::find(*reference->lights, own.count, &records::LightCountRecord::count);
  if (under != reference->lights->end())
    point.cost = {scale(own.moving_ratio, under->moving_ms), scale(own.static_ratio, under->static_ms)};
  return point;
}

std::vector<CostCurve> make_light_curves(const TradeScope& scope, int map_size,
                                         const std::vector<records::CellRecord>& cells) {
  std::vector<TradeConfiguration> timed;
  const records::CellRecord* reference = nullptr;
  for (const TradeConfiguration& each : scope.configurations) {
    const records::CellRecord& cell = cells[each.cells.front()];
    if (each.map_size != map_size || !cell.lights || cell.lights->empty()) continue;
    timed.push_back(each);
    if (is_reference(cell)) reference = &cell;
  }
  label_configurations(timed, cells);
  std::vector<CostCurve> curves;
  for (const TradeConfiguration& each : timed) {
    CostCurve& curve = curves.emplace_back(CostCurve{each.filter, each.label, {}});
    for (const records::LightCountRecord& own : *cells[each.cells.front()].lights) {
      curve.points.push_back(make_light_point(own, reference));
      curve.maps_bytes = own.maps_bytes;
    }
  }
  return curves;
}

// One chart of each scene, view and picture, and each size of its maps, of which `says` has something to say.
template <class MakeCurves, class Says>
std::vector<CostChart> make_charts(CurveAxis axis, const std::vector<records::CellRecord>& cells,
                                   const std::vector<TradeScope>& scopes, MakeCurves make_curves, Says says) {
  std::vector<CostChart> charts;
  for (const TradeScope& scope : scopes) {
    if (scope.scene.empty()) continue;
    std::set<int> map_sizes;
    for (const TradeConfiguration& each : scope.configurations) map_sizes.insert(each.map_size);
    for (const int map_size : map_sizes) {
      CostChart chart{scope.id,    fmt::format("{} · map {}", scope.title, map_size),
                      map_size,    axis,
                      scope.costs, make_curves(scope, map_size, cells)};
      if (says(chart)) charts.push_back(std::move(chart));
    }
  }
  return charts;
}

bool has_point(const CostCurve& curve, double at) {
  return std::ranges::find(curve.points, at, &CurvePoint::at) != curve.points.end();
}

std::vector<double> list_measured_of(const std::vector<const CostCurve*>& curves) {
  std::set<double> all;
  for (const CostCurve* curve : curves)
    for (const CurvePoint& point : curve->points) all.insert(point.at);
  std::vector<double> distinct;
  for (const double at : all)
    if (distinct.empty() || !are_same(distinct.back(), at)) distinct.push_back(at);
  return distinct;
}

double lerp(double a, double b, double t) { return a + (b - a) * t; }

// Between times: straight where steps of the axis are ratios.
double lerp_time(double a, double b, double t) { return a > 0.0 && b > 0.0 ? a * std::pow(b / a, t) : lerp(a, b, t); }

// Where the curves meet between two widths; nothing where they do not.
std::optional<std::pair<double, double>> find_crossing(const CostCurve& a, const CostCurve& b, double from, double to,
                                                       LightMotion light) {
  const double a0 = cost_at(a, from, light)->value, a1 = cost_at(a, to, light)->value;
  const double b0 = cost_at(b, from, light)->value, b1 = cost_at(b, to, light)->value;
  if (!(std::min({a0, a1, b0, b1}) > 0.0)) return std::nullopt;
  const double before = std::log(a0 / b0), after = std::log(a1 / b1);
  if (before * after >= 0.0) return std::nullopt;
  const double t = before / (before - after);
  return std::pair(lerp(from, to, t), lerp_time(a0, a1, t));
}

CurveComparison compare_pair(const CostChart& chart, std::size_t a, std::size_t b) {
  const CostCurve &x = chart.curves[a], &y = chart.curves[b];
  CurveComparison result{a, b, {}, {}, {}};
  for (const double at : list_measured_of({&x, &y})) {
    if (chart.axis == CurveAxis::kLights && !(has_point(x, at) && has_point(y, at))) continue;
    if (!cost_at(x, at, LightMotion::kStatic) || !cost_at(y, at, LightMotion::kStatic)) continue;
    for (const LightMotion light : kBothLights) {
      const Estimate left = *cost_at(x, at, light), right = *cost_at(y, at, light);
      result.signs[light].push_back(is_clearly_less_cost(left, right) ? -1 : is_clearly_less_cost(right, left) ? 1 : 0);
      if (result.at.empty()) continue;
      if (const auto crossing = find_crossing(x, y, result.at.back(), at, light))
        result.crossings[light].push_back(*crossing);
    }
    result.at.push_back(at);
  }
  return result;
}

using Points = std::vector<std::pair<double, double>>;

// Fits a line by least squares; returns its slope.
double fit_slope(const Points& points) {
  const double count = static_cast<double>(points.size());
  double x = 0.0, y = 0.0, xx = 0.0, xy = 0.0;
  for (const auto& [at, value] : points) {
    x += at / count;
    y += value / count;
  }
  for (const auto& [at, value] : points) {
    xx += (at - x) * (at - x);
    xy += (at - x) * (value - y);
  }
  return xy / xx;
}

// Fits the medians, and the flattest and the steepest line through the quartiles: least squares weigh a point by its
// distance from the middle of the counts, as `scale` has them.
template <class Fit>
Estimate fit_with_spread(const CostCurve& curve, LightMotion light, Fit fit, double (*scale)(double)) {
  std::vector<std::pair<double, double>> medians, flattest, steepest;
  double middle = 0.0;
  for (const CurvePoint& point : curve.points) middle += scale(point.at) / static_cast<double>(curve.points.size());
  for (const CurvePoint& point : curve.points) {
    const Estimate& time = point.spread[light];
    const bool beyond = scale(point.at) > middle;
    medians.push_back({point.at, time.value});
    flattest.push_back({point.at, beyond ? time.low : time.high});
    steepest.push_back({point.at, beyond ? time.high : time.low});
  }
  return {fit(medians), fit(flattest), fit(steepest)};
}

// How far medians are from the line of least squares, which goes through their mean.
std::optional<double> find_off_line(const CostCurve& curve, LightMotion light, double slope) {
  if (curve.points.size() < 3) return std::nullopt;
  double offset = 0.0, farthest = 0.0;
  for (const CurvePoint& point : curve.points)
    offset += (point.spread[light].value - slope * point.at) / static_cast<double>(curve.points.size());
  for (const CurvePoint& point : curve.points) {
    const double time = point.spread[light].value;
    farthest = std::max(farthest, std::abs(offset + slope * point.at - time) / time);
  }
  return farthest;
}

}  // namespace

bool CurveComparison::has(int sign) const {
  return std::ranges::count(signs.static_light, sign) + std::ranges::count(signs.moving, sign) > 0;
}

std::vector<CostChart> make_width_charts(const std::vector<records::CellRecord>& cells,
                                         const std::vector<TradeScope>& scopes) {
  return make_charts(
      CurveAxis::kWidth, cells, scopes, make_width_curves,
      [](const CostChart& chart) { return !compare_curves(chart).empty(); });
}

std::vector<CostChart> make_light_charts(const std::vector<records::CellRecord>& cells,
                                         const std::vector<TradeScope>& scopes) {
  return make_charts(
      CurveAxis::kLights, cells, scopes, make_light_curves,
      [](const CostChart& chart) { return !chart.curves.empty(); });
}

std::vector<double> list_measured(std::span<const CostChart> charts) {
  std::vector<const CostCurve*> curves;
  for (const CostChart& chart : charts)
    for (const CostCurve& curve : chart.curves) curves.push_back(&curve);
  return list_measured_of(curves);
}

std::optional<Estimate> cost_at(const CostCurve& curve, double at, LightMotion light) {
  const CurvePoint* before = nullptr;
  for (const CurvePoint& point : curve.points) {
    if (are_same(point.at, at)) return point.cost[light];
    if (point.at > at) {
      if (!before) return std::nullopt;
      const double t = (at - before->at) / (point.at - before->at);
      const Estimate &a = before->cost[light], &b = point.cost[light];
      return Estimate{lerp_time(a.value, b.value, t), lerp_time(a.low, b.low, t), lerp_time(a.high, b.high, t)};
    }
    before = &point;
  }
  return std::nullopt;
}

std::vector<CurveComparison> compare_curves(const CostChart& chart) {
  std::vector<CurveComparison> comparisons;
  for (std::size_t a = 0; a < chart.curves.size(); ++a) {
    for (std::size_t b = 0; b < chart.curves.size(); ++b) {
      const bool is_pair =
          chart.axis == CurveAxis::kLights ? a < b : chart.curves[a].prefiltered && chart.curves[b].many_taps;
      if (!is_pair) continue;
      CurveComparison comparison = compare_pair(chart, a, b);
      if (!comparison.at.empty()) comparisons.push_back(std::move(comparison));
    }
  }
  return comparisons;
}

double fit_exponent(Points points) {
  for (auto& [size, time] : points) {
    size = std::log(size);
    time = std::log(time);
  }
  return fit_slope(points);
}

LightGrowth find_light_growth(const CostCurve& curve, LightMotion light) {
  assert(curve.points.size() > 1);
  const Estimate slope = fit_with_spread(
      curve, light, fit_slope, [](double count) { return count; });
  return {slope, fit_with_spread(curve, light, fit_exponent, [](double count) { return std::log(count); }),
          find_off_line(curve, light, slope.value)};
}

}  // namespace shadowbench::analysis
