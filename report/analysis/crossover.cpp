#include "report/analysis/crossover.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

namespace shadowbench::analysis {
namespace {

// Widths that differ by less than this share are taken for the same.
constexpr double kSameWidth = 0.01;

bool are_same_width(double a, double b) { return std::abs(a - b) <= kSameWidth * std::max(a, b); }

// Whether a filter reads the map at many places of its kernel.
bool has_many_taps(const records::CellRecord& cell) {
  return cell.cost.fetches.value_or(0.0) > 1.0 && cell.kernel_radius_texels.value_or(0.0) > 0.0;
}

WidthCurve make_curve(const TradeScope& scope, const WidthSeries& series,
                      const std::vector<records::CellRecord>& cells) {
  const records::CellRecord& last = cells[scope.configurations[series.configurations.back()].cells.front()];
  const bool prefiltered = last.cost.prefilter_texels.value_or(0) > 0;
  WidthCurve curve{series.filter, series.label, prefiltered, !prefiltered && has_many_taps(last), {}};
  for (const std::size_t i : series.configurations) {
    const TradeConfiguration& each = scope.configurations[i];
    curve.points.push_back({*each.sigma_texels, *each.costs[kStillCost].estimate, *each.costs[kMovingCost].estimate});
  }
  return curve;
}

WidthChart make_chart(const TradeScope& scope, int map_size, const std::vector<records::CellRecord>& cells) {
  std::vector<std::size_t> timed;
  for (std::size_t i = 0; i < scope.configurations.size(); ++i) {
    const TradeConfiguration& each = scope.configurations[i];
    if (each.map_size == map_size && each.costs[kStillCost].estimate && each.costs[kMovingCost].estimate)
      timed.push_back(i);
  }
  WidthChart chart{scope.id,     fmt::format("{} · map {}", scope.title, map_size),
                   scope.scene,  scope.view,
                   map_size,     scope.width,
                   scope.height, {},
                   scope.costs};
  for (const WidthSeries& series : list_width_series(scope.configurations, timed))
    chart.curves.push_back(make_curve(scope, series, cells));
  return chart;
}

const Estimate& time_of(const WidthPoint& point, LightState light) {
  return light == LightState::kStill ? point.still : point.moving;
}

double lerp(double a, double b, double t) { return a + (b - a) * t; }

// Between times: straight where steps of the axis are ratios.
double lerp_time(double a, double b, double t) { return a > 0.0 && b > 0.0 ? a * std::pow(b / a, t) : lerp(a, b, t); }

std::vector<double> list_widths(const WidthCurve& a, const WidthCurve& b) {
  std::set<double> widths;
  for (const WidthCurve* curve : {&a, &b})
    for (const WidthPoint& point : curve->points) widths.insert(point.sigma_texels);
  std::vector<double> distinct;
  for (const double width : widths)
    if (distinct.empty() || !are_same_width(distinct.back(), width)) distinct.push_back(width);
  return distinct;
}

// Where the curves meet between two widths; nothing where they do not.
std::optional<WidthPoint> find_crossing(const WidthCurve& a, const WidthCurve& b, double from, double to,
                                        LightState light) {
  const double a0 = time_at(a, from, light)->value, a1 = time_at(a, to, light)->value;
  const double b0 = time_at(b, from, light)->value, b1 = time_at(b, to, light)->value;
  if (!(std::min({a0, a1, b0, b1}) > 0.0)) return std::nullopt;
  const double before = std::log(a0 / b0), after = std::log(a1 / b1);
  if (before * after >= 0.0) return std::nullopt;
  const double t = before / (before - after);
  const double ms = lerp_time(a0, a1, t);
  return WidthPoint{lerp(from, to, t), {ms, ms, ms}, {ms, ms, ms}};
}

CurveComparison compare_pair(const WidthChart& chart, std::size_t prefiltered, std::size_t taps, LightState light) {
  const WidthCurve &a = chart.curves[prefiltered], &b = chart.curves[taps];
  CurveComparison result{prefiltered, taps, light, {}, {}, {}};
  for (const double width : list_widths(a, b)) {
    const auto left = time_at(a, width, light), right = time_at(b, width, light);
    if (!left || !right) continue;
    if (!result.widths.empty()) {
      if (const auto crossing = find_crossing(a, b, result.widths.back(), width, light))
        result.crossings.push_back(*crossing);
    }
    result.widths.push_back(width);
    result.signs.push_back(is_clearly_less_cost(*left, *right) ? -1 : is_clearly_less_cost(*right, *left) ? 1 : 0);
  }
  return result;
}

}  // namespace

std::vector<WidthChart> make_width_charts(const std::vector<records::CellRecord>& cells,
                                          const std::vector<TradeScope>& scopes) {
  std::vector<WidthChart> charts;
  for (const TradeScope& scope : scopes) {
    if (scope.scene.empty()) continue;
    std::set<int> map_sizes;
    for (const TradeConfiguration& each : scope.configurations) map_sizes.insert(each.map_size);
    for (const int map_size : map_sizes) {
      WidthChart chart = make_chart(scope, map_size, cells);
      const bool compared = !compare_curves(chart, LightState::kStill).empty();
      if (compared) charts.push_back(std::move(chart));
    }
  }
  return charts;
}

std::optional<Estimate> time_at(const WidthCurve& curve, double sigma_texels, LightState light) {
  const WidthPoint* before = nullptr;
  for (const WidthPoint& point : curve.points) {
    if (are_same_width(point.sigma_texels, sigma_texels)) return time_of(point, light);
    if (point.sigma_texels > sigma_texels) {
      if (!before) return std::nullopt;
      const double t = (sigma_texels - before->sigma_texels) / (point.sigma_texels - before->sigma_texels);
      const Estimate &a = time_of(*before, light), &b = time_of(point, light);
      return Estimate{lerp_time(a.value, b.value, t), lerp_time(a.low, b.low, t), lerp_time(a.high, b.high, t)};
    }
    before = &point;
  }
  return std::nullopt;
}

std::vector<CurveComparison> compare_curves(const WidthChart& chart, LightState light) {
  std::vector<CurveComparison> comparisons;
  for (std::size_t i = 0; i < chart.curves.size(); ++i) {
    for (std::size_t k = 0; k < chart.curves.size(); ++k) {
      if (!chart.curves[i].prefiltered || !chart.curves[k].many_taps) continue;
      CurveComparison comparison = compare_pair(chart, i, k, light);
      if (!comparison.widths.empty()) comparisons.push_back(std::move(comparison));
    }
  }
  return comparisons;
}

}  // namespace shadowbench::analysis
