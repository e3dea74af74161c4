#include "report/analysis/crossover.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "report/analysis/summary.h"
#include "report/records/format.h"
#include "report/records/json_values.h"

namespace shadowbench::analysis {
namespace {

// A configuration whose kernel radius and times are known.
struct TimedConfiguration {
  const TradeConfiguration* configuration;
  double radius;
  RadiusPoint point;
  bool prefiltered;
  bool many_taps;
};

std::optional<TimedConfiguration> read_timed(const TradeConfiguration& configuration, const records::CellRecord& cell) {
  const auto& still = configuration.costs[1].estimate;
  const auto& moving = configuration.costs[0].estimate;
  if (!cell.kernel_radius_texels || !still || !moving) return std::nullopt;
  const bool prefiltered = cell.cost.prefilter_texels.value_or(0) > 0;
  const bool many_taps = !prefiltered && cell.cost.fetches.value_or(0.0) > 1.0 && *cell.kernel_radius_texels > 0.0;
  return TimedConfiguration{&configuration,
                            *cell.kernel_radius_texels,
                            {*cell.kernel_radius_texels, *still, *moving},
                            prefiltered,
                            many_taps};
}

// The parameters of a filter that say no more than its radius: each of their values has one radius and each radius one
// value.
std::set<std::string> find_radius_params(const std::vector<TimedConfiguration>& timed, const std::string& filter) {
  std::map<std::string, std::set<std::pair<double, std::string>>> pairs;
  std::map<std::string, std::set<std::string>> values;
  std::set<double> radii;
  for (const TimedConfiguration& each : timed) {
    if (each.configuration->filter != filter) continue;
    radii.insert(each.radius);
    for (const auto& [name, value] : each.configuration->params) {
      const std::string text = records::describe_params({{name, value}});
      pairs[name].insert({each.radius, text});
      values[name].insert(text);
    }
  }
  std::set<std::string> names;
  for (const auto& [name, found] : pairs)
    if (found.size() == radii.size() && values[name].size() == radii.size() && radii.size() > 1) names.insert(name);
  return names;
}

records::ParamMap without(records::ParamMap params, const std::set<std::string>& names) {
  std::erase_if(params, [&](const auto& param) { return names.count(param.first) != 0; });
  return params;
}

void add_point(std::vector<RadiusCurve>& curves, std::map<std::string, std::size_t>& places,
               const TimedConfiguration& each, const records::ParamMap& params) {
  const std::string key = each.configuration->filter + records::dump_line(records::value_json(params));
  const auto [place, is_new] = places.emplace(key, curves.size());
  if (is_new)
    curves.push_back(
        {each.configuration->filter, records::describe_params(params), each.prefiltered, each.many_taps, {}});
  curves[place->second].points.push_back(each.point);
}

// A curve's parameters are named where its filter has several curves.
void label_curves(std::vector<RadiusCurve>& curves) {
  std::map<std::string, int> counts;
  for (const RadiusCurve& curve : curves) ++counts[curve.filter];
  for (RadiusCurve& curve : curves) {
    const bool told = counts[curve.filter] > 1 && !curve.label.empty();
    curve.label = told ? fmt::format("{} ({})", curve.filter, curve.label) : curve.filter;
  }
}

std::vector<RadiusCurve> make_curves(const std::vector<TimedConfiguration>& timed) {
  std::vector<RadiusCurve> curves;
  std::map<std::string, std::size_t> places;
  for (const TimedConfiguration& each : timed) {
    const auto names = find_radius_params(timed, each.configuration->filter);
    add_point(curves, places, each, without(each.configuration->params, names));
  }
  for (RadiusCurve& curve : curves) {
    std::sort(
        curve.points.begin(), curve.points.end(),
        [](const RadiusPoint& a, const RadiusPoint& b) { return a.radius_texels < b.radius_texels; });
  }
  label_curves(curves);
  return curves;
}

RadiusChart make_chart(const TradeScope& scope, int map_size, const std::vector<records::CellRecord>& cells) {
  std::vector<TimedConfiguration> timed;
  for (const TradeConfiguration& each : scope.configurations) {
    if (each.map_size != map_size) continue;
    if (const auto read = read_timed(each, cells[each.cells.front()])) timed.push_back(*read);
  }
  return {scope.id,     fmt::format("{} · map {}", scope.title, map_size),
          scope.scene,  scope.view,
          map_size,     scope.width,
          scope.height, make_curves(timed)};
}

const Estimate& time_of(const RadiusPoint& point, LightState light) {
  return light == LightState::kStill ? point.still : point.moving;
}

double lerp(double a, double b, double t) { return a + (b - a) * t; }

// Between times: straight where steps of the axis are ratios.
double lerp_time(double a, double b, double t) { return a > 0.0 && b > 0.0 ? a * std::pow(b / a, t) : lerp(a, b, t); }

std::vector<double> list_radii(const RadiusCurve& a, const RadiusCurve& b) {
  std::set<double> radii;
  for (const RadiusCurve* curve : {&a, &b})
    for (const RadiusPoint& point : curve->points) radii.insert(point.radius_texels);
  return {radii.begin(), radii.end()};
}

// Where the curves meet between two radii; nothing where they do not.
std::optional<RadiusPoint> find_crossing(const RadiusCurve& a, const RadiusCurve& b, double from, double to,
                                         LightState light) {
  const double a0 = time_at(a, from, light)->value, a1 = time_at(a, to, light)->value;
  const double b0 = time_at(b, from, light)->value, b1 = time_at(b, to, light)->value;
  if (!(std::min({a0, a1, b0, b1}) > 0.0)) return std::nullopt;
  const double before = std::log(a0 / b0), after = std::log(a1 / b1);
  if (before * after >= 0.0) return std::nullopt;
  const double t = before / (before - after);
  const double ms = lerp_time(a0, a1, t);
  return RadiusPoint{lerp(from, to, t), {ms, ms, ms}, {ms, ms, ms}};
}

CurveComparison compare_pair(const RadiusChart& chart, std::size_t prefiltered, std::size_t taps, LightState light) {
  const RadiusCurve &a = chart.curves[prefiltered], &b = chart.curves[taps];
  CurveComparison result{prefiltered, taps, light, {}, {}, {}};
  for (const double radius : list_radii(a, b)) {
    const auto left = time_at(a, radius, light), right = time_at(b, radius, light);
    if (!left || !right) continue;
    if (!result.radii.empty()) {
      if (const auto crossing = find_crossing(a, b, result.radii.back(), radius, light))
        result.crossings.push_back(*crossing);
    }
    result.radii.push_back(radius);
    result.signs.push_back(is_clearly_less_cost(*left, *right) ? -1 : is_clearly_less_cost(*right, *left) ? 1 : 0);
  }
  return result;
}

}  // namespace

std::vector<RadiusChart> make_radius_charts(const std::vector<records::CellRecord>& cells,
                                            const std::vector<TradeScope>& scopes) {
  std::vector<RadiusChart> charts;
  for (const TradeScope& scope : scopes) {
    if (scope.scene.empty()) continue;
    std::set<int> map_sizes;
    for (const TradeConfiguration& each : scope.configurations) map_sizes.insert(each.map_size);
    for (const int map_size : map_sizes) {
      RadiusChart chart = make_chart(scope, map_size, cells);
      const bool compared = !compare_curves(chart, LightState::kStill).empty();
      if (compared) charts.push_back(std::move(chart));
    }
  }
  return charts;
}

std::optional<Estimate> time_at(const RadiusCurve& curve, double radius_texels, LightState light) {
  const RadiusPoint* before = nullptr;
  for (const RadiusPoint& point : curve.points) {
    if (point.radius_texels == radius_texels) return time_of(point, light);
    if (point.radius_texels > radius_texels) {
      if (!before) return std::nullopt;
      const double t = (radius_texels - before->radius_texels) / (point.radius_texels - before->radius_texels);
      const Estimate &a = time_of(*before, light), &b = time_of(point, light);
      return Estimate{lerp_time(a.value, b.value, t), lerp_time(a.low, b.low, t), lerp_time(a.high, b.high, t)};
    }
    before = &point;
  }
  return std::nullopt;
}

std::vector<CurveComparison> compare_curves(const RadiusChart& chart, LightState light) {
  std::vector<CurveComparison> comparisons;
  for (std::size_t i = 0; i < chart.curves.size(); ++i) {
    for (std::size_t k = 0; k < chart.curves.size(); ++k) {
      if (!chart.curves[i].prefiltered || !chart.curves[k].many_taps) continue;
      CurveComparison comparison = compare_pair(chart, i, k, light);
      if (!comparison.radii.empty()) comparisons.push_back(std::move(comparison));
    }
  }
  return comparisons;
}

}  // namespace shadowbench::analysis
