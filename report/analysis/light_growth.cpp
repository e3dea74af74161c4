#include "report/analysis/light_growth.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <optional>
#include <set>

#include "report/analysis/growth.h"
#include "report/analysis/summary.h"
#include "report/records/format.h"
#include "report/records/text_table.h"

namespace shadowbench::analysis {
namespace {

constexpr double kMebibyte = 1024.0 * 1024.0;

const records::LightCountRecord* find_count(const records::CellRecord& cell, int count) {
  if (!cell.lights) return nullptr;
  const auto found = std::find_if(cell.lights->begin(), cell.lights->end(),
                                  [&](const records::LightCountRecord& each) { return each.count == count; });
  return found == cell.lights->end() ? nullptr : &*found;
}

Estimate read_spread(const records::Quartiles& time) { return {time.median, time.q1, time.q3}; }

Estimate estimate(const records::Quartiles& time, const records::Ratio& ratio, const records::Quartiles* reference) {
  if (!reference) return read_spread(time);
  return {ratio.median * reference->median, ratio.ci95.low * reference->median, ratio.ci95.high * reference->median};
}

LightPoint make_point(const records::LightCountRecord& own, const records::LightCountRecord* reference) {
  return {own.count,
          estimate(own.still_ms, own.still_ratio, reference ? &reference->still_ms : nullptr),
          estimate(own.moving_ms, own.moving_ratio, reference ? &reference->moving_ms : nullptr),
          read_spread(own.still_ms),
          read_spread(own.moving_ms),
          own.maps_bytes};
}

LightCurve make_curve(const TradeConfiguration& configuration, const records::CellRecord& cell,
                      const records::CellRecord* reference) {
  LightCurve curve{configuration.filter, configuration.label, {}};
  for (const records::LightCountRecord& each : *cell.lights)
    curve.points.push_back(make_point(each, reference ? find_count(*reference, each.count) : nullptr));
  return curve;
}

LightChart make_light_chart(const TradeScope& scope, int map_size, const std::vector<records::CellRecord>& cells) {
  std::vector<TradeConfiguration> timed;
  const records::CellRecord* reference = nullptr;
  for (const TradeConfiguration& each : scope.configurations) {
    const records::CellRecord& cell = cells[each.cells.front()];
    if (each.map_size != map_size || !cell.lights) continue;
    timed.push_back(each);
    if (is_reference(cell)) reference = &cell;
  }
  label_configurations(timed);
  LightChart chart{scope.id,
                   fmt::format("{} · map {}", scope.title, map_size),
                   scope.scene,
                   scope.view,
                   map_size,
                   scope.width,
                   scope.height,
                   {},
                   {}};
  std::set<int> counts;
  for (const TradeConfiguration& each : timed) {
    chart.curves.push_back(make_curve(each, cells[each.cells.front()], reference));
    for (const LightPoint& point : chart.curves.back().points) counts.insert(point.count);
  }
  chart.counts.assign(counts.begin(), counts.end());
  return chart;
}

const LightPoint* find_point(const LightCurve& curve, int count) {
  const auto found = std::find_if(curve.points.begin(), curve.points.end(),
                                  [&](const LightPoint& each) { return each.count == count; });
  return found == curve.points.end() ? nullptr : &*found;
}

int compare(const Estimate& a, const Estimate& b) {
  return is_clearly_less_cost(a, b) ? -1 : is_clearly_less_cost(b, a) ? 1 : 0;
}

LightComparison compare_pair(const LightChart& chart, std::size_t a, std::size_t b) {
  LightComparison result{a, b, {}, {}, {}};
  for (const int count : chart.counts) {
    const LightPoint *left = find_point(chart.curves[a], count), *right = find_point(chart.curves[b], count);
    if (!left || !right) continue;
    result.counts.push_back(count);
    result.still.push_back(compare(left->still, right->still));
    result.moving.push_back(compare(left->moving, right->moving));
  }
  return result;
}

bool has_sign(const LightComparison& comparison, int sign) {
  const auto has = [sign](const std::vector<int>& signs) {
    return std::find(signs.begin(), signs.end(), sign) != signs.end();
  };
  return has(comparison.still) || has(comparison.moving);
}

using Points = std::vector<std::pair<double, double>>;

double fit_slope(const Points& points) {
  double x = 0.0, y = 0.0, xx = 0.0, xy = 0.0;
  for (const auto& [count, time] : points) {
    x += count / static_cast<double>(points.size());
    y += time / static_cast<double>(points.size());
  }
  for (const auto& [count, time] : points) {
    xx += (count - x) * (count - x);
    xy += (count - x) * (time - y);
  }
  return xy / xx;
}

// Fits the medians, and the flattest and the steepest line through the quartiles: least squares weigh a point by its
// distance from the middle of the counts, as `scale` has them.
Estimate fit_with_spread(const LightCurve& curve, LightState light, double (*fit)(const Points&),
                         double (*scale)(double)) {
  Points medians, flattest, steepest;
  double middle = 0.0;
  for (const LightPoint& point : curve.points) middle += scale(point.count) / static_cast<double>(curve.points.size());
  for (const LightPoint& point : curve.points) {
    const Estimate& time = light == LightState::kStill ? point.still_spread : point.moving_spread;
    const bool beyond = scale(point.count) > middle;
    medians.push_back({point.count, time.value});
    flattest.push_back({point.count, beyond ? time.low : time.high});
    steepest.push_back({point.count, beyond ? time.high : time.low});
  }
  return {fit(medians), fit(flattest), fit(steepest)};
}

// How far medians are from the line of least squares, which goes through their mean.
std::optional<double> find_off_line(const LightCurve& curve, LightState light, double slope) {
  if (curve.points.size() < 3) return std::nullopt;
  const double points = static_cast<double>(curve.points.size());
  const auto time_of = [&](const LightPoint& point) {
    return light == LightState::kStill ? point.still_spread.value : point.moving_spread.value;
  };
  double offset = 0.0, farthest = 0.0;
  for (const LightPoint& point : curve.points) offset += (time_of(point) - slope * point.count) / points;
  for (const LightPoint& point : curve.points)
    farthest = std::max(farthest, std::abs(offset + slope * point.count - time_of(point)) / time_of(point));
  return farthest;
}

std::vector<std::string> make_row(const LightChart& chart, const LightCurve& curve, LightState light) {
  std::vector<std::string> row{curve.label, light == LightState::kStill ? "still" : "moving"};
  for (const int count : chart.counts) {
    const LightPoint* point = find_point(curve, count);
    row.push_back(point ? format_time(frame_time(*point, light)) : records::kNothing);
  }
  const bool grows = curve.points.size() > 1;
  const LightGrowth growth = grows ? find_light_growth(curve, light) : LightGrowth();
  row.push_back(grows ? format_time(growth.per_light_ms) : records::kNothing);
  row.push_back(grows ? format_exponent(growth.exponent) : records::kNothing);
  row.push_back(records::format_number(static_cast<double>(curve.points.back().maps_bytes) / kMebibyte));
  return row;
}

}  // namespace

std::string format_time(const Estimate& time) {
  if (time.low == time.high) return records::format_number(time.value);
  return fmt::format("{} [{}, {}]", records::format_number(time.value), records::format_number(time.low),
                     records::format_number(time.high));
}

std::string format_exponent(const Estimate& exponent) {
  if (exponent.low == exponent.high) return fmt::format("{:.2f}", exponent.value);
  return fmt::format("{:.2f} [{:.2f}, {:.2f}]", exponent.value, exponent.low, exponent.high);
}

bool LightComparison::changes() const { return has_sign(*this, -1) && has_sign(*this, 1); }

bool LightComparison::is_apart() const { return has_sign(*this, -1) || has_sign(*this, 1); }

std::vector<LightChart> make_light_charts(const std::vector<records::CellRecord>& cells,
                                          const std::vector<TradeScope>& scopes) {
  std::vector<LightChart> charts;
  for (const TradeScope& scope : scopes) {
    if (scope.scene.empty()) continue;
    std::set<int> map_sizes;
    for (const TradeConfiguration& each : scope.configurations) map_sizes.insert(each.map_size);
    for (const int map_size : map_sizes) {
      LightChart chart = make_light_chart(scope, map_size, cells);
      if (!chart.counts.empty()) charts.push_back(std::move(chart));
    }
  }
  return charts;
}

const Estimate& frame_time(const LightPoint& point, LightState light) {
  return light == LightState::kStill ? point.still : point.moving;
}

LightGrowth find_light_growth(const LightCurve& curve, LightState light) {
  assert(curve.points.size() > 1);
  const Estimate slope = fit_with_spread(
      curve, light, fit_slope, [](double count) { return count; });
  return {slope, fit_with_spread(curve, light, fit_exponent, [](double count) { return std::log(count); }),
          find_off_line(curve, light, slope.value)};
}

std::vector<LightComparison> compare_light_curves(const LightChart& chart) {
  std::vector<LightComparison> comparisons;
  for (std::size_t a = 0; a < chart.curves.size(); ++a) {
    for (std::size_t b = a + 1; b < chart.curves.size(); ++b) {
      LightComparison comparison = compare_pair(chart, a, b);
      if (!comparison.counts.empty()) comparisons.push_back(std::move(comparison));
    }
  }
  return comparisons;
}

records::TextTable make_light_table(const LightChart& chart) {
  records::TextTable table;
  table.header = {"filter", "casters"};
  for (const int count : chart.counts) table.header.push_back(fmt::format("{} light{}", count, count == 1 ? "" : "s"));
  table.header.insert(table.header.end(), {"ms per added light", "exponent", "MiB of maps at the most lights"});
  for (const LightCurve& curve : chart.curves)
    for (const LightState light : {LightState::kStill, LightState::kMoving})
      table.rows.push_back(make_row(chart, curve, light));
  return table;
}

}  // namespace shadowbench::analysis
