#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>

#include "report/analysis/cost_curves.h"
#include "report/records/cell_key.h"
#include "report/records/format.h"
#include "report/records/json_values.h"

namespace shadowbench::analysis {
namespace {

constexpr double kMebibyte = 1024.0 * 1024.0;

const char* name_light(LightMotion light) { return light == LightMotion::kStatic ? "static" : "moving"; }

// Where a comparison has a sign: "2, 4".
std::string join_places(const CurveComparison& comparison, LightMotion light, int sign) {
  std::vector<std::string> places;
  for (std::size_t i = 0; i < comparison.at.size(); ++i)
    if (comparison.signs[light][i] == sign) places.push_back(records::format_number(comparison.at[i]));
  return places.empty() ? records::kNothing : fmt::format("{}", fmt::join(places, ", "));
}

std::string list_numbers(const std::vector<double>& numbers) {
  std::vector<std::string> texts;
  for (const double number : numbers) texts.push_back(records::format_number(number));
  return fmt::format("{}", fmt::join(texts, ", "));
}

std::string format_time(const Estimate& time) {
  return time.low == time.high ? records::format_number(time.value)
                               : records::format_interval(time.value, {time.low, time.high});
}

std::string format_exponent(const Estimate& exponent) {
  if (exponent.low == exponent.high) return fmt::format("{:.2f}", exponent.value);
  return fmt::format("{:.2f} [{:.2f}, {:.2f}]", exponent.value, exponent.low, exponent.high);
}

std::vector<std::string> make_light_row(const CostChart& chart, const CostCurve& curve, LightMotion light,
                                        const std::vector<double>& counts) {
  std::vector<std::string> row{curve.label, name_light(light), chart.title};
  for (const double count : counts) {
    const auto point = std::ranges::find(curve.points, count, &CurvePoint::at);
    row.push_back(point == curve.points.end() ? records::kNothing : format_time(point->cost[light]));
  }
  const auto growth = curve.points.size() > 1 ? std::optional(find_light_growth(curve, light)) : std::nullopt;
  row.push_back(growth ? format_time(growth->per_light_ms) : records::kNothing);
  row.push_back(growth ? format_exponent(growth->exponent) : records::kNothing);
  row.push_back(growth && growth->off_line ? fmt::format("{:.1f} %", 100.0 * *growth->off_line) : records::kNothing);
  row.push_back(records::format_number(static_cast<double>(curve.maps_bytes) / kMebibyte));
  return row;
}

using Points = std::vector<std::pair<double, double>>;

// Which time is compared, and over which size.
struct Law {
  const char* name;
  const char* size;  // of the settings
  std::optional<records::Quartiles> records::TimeRecord::*time;
  const char* unit;
};

constexpr Law kLaws[] = {{"lookup over the picture", "size", &records::TimeRecord::lookup, "pixels"},
                         {"lookup over the map", "map_size", &records::TimeRecord::lookup, "texels"},
                         {"prefilter over the map", "map_size", &records::TimeRecord::prefilter, "texels"}};

// By filter, the series of cells that differ in the size alone and have several, smallest first.
std::map<std::string, std::vector<Points>> list_series(const std::vector<records::CellRecord>& cells, const Law& law) {
  std::map<std::pair<std::string, std::string>, Points> all;
  for (const records::CellRecord& cell : cells) {
    const auto& time = cell.time_ms.*law.time;
    const double size = &law == &kLaws[0] ? static_cast<double>(cell.width) * cell.height
                                          : static_cast<double>(cell.map_size) * cell.map_size;
    if (!time || !(time->median > 0.0) || !(size > 0.0)) continue;
    auto settings = records::cell_settings(cell);
    settings.erase(law.size);
    all[{cell.filter, records::dump_line(settings)}].push_back({size, time->median});
  }
  std::map<std::string, std::vector<Points>> series;
  for (auto& [key, points] : all) {
    std::ranges::sort(points);
    if (points.front().first < points.back().first) series[key.first].push_back(std::move(points));
  }
  return series;
}

std::string format_growth(double exponent) {
  return fmt::format("{:.2f}", std::abs(exponent) < 0.005 ? 0.0 : exponent);
}

// The median of the series' exponents, and of several the least and the most.
std::string describe_series(const std::vector<Points>& series) {
  std::vector<double> exponents;
  for (const Points& points : series) exponents.push_back(fit_exponent(points));
  std::ranges::sort(exponents);
  const std::size_t middle = exponents.size() / 2;
  const double median =
      exponents.size() % 2 == 1 ? exponents[middle] : 0.5 * (exponents[middle - 1] + exponents[middle]);
  if (exponents.size() == 1) return format_growth(median);
  return fmt::format("{}, {} to {} in {} series", format_growth(median), format_growth(exponents.front()),
                     format_growth(exponents.back()), exponents.size());
}

std::string describe_law(const Law& law, const std::map<std::string, std::vector<Points>>& all) {
  double from = INFINITY, to = 0.0;
  for (const auto& [filter, series] : all) {
    for (const Points& points : series) {
      from = std::min(from, points.front().first);
      to = std::max(to, points.back().first);
    }
  }
  return fmt::format("{}, {} to {} {}", law.name, records::format_number(from), records::format_number(to), law.unit);
}

// In how many comparisons `a` is cheaper somewhere, and in which at the least place.
std::string summarize_light(const std::vector<CostChart>& charts, LightMotion light) {
  std::size_t all = 0, cheaper = 0;
  double least = std::numeric_limits<double>::infinity();
  std::string where;
  for (const CostChart& chart : charts) {
    for (const CurveComparison& each : compare_curves(chart)) {
      const auto first = std::ranges::find(each.signs[light], -1);
      ++all;
      if (first == each.signs[light].end()) continue;
      ++cheaper;
      const double at = each.at[static_cast<std::size_t>(first - each.signs[light].begin())];
      if (at >= least) continue;
      least = at;
      where =
          fmt::format(", from a kernel width of {} texels on at the earliest ({} against {} on {})",
                      records::format_number(at), chart.curves[each.a].label, chart.curves[each.b].label, chart.title);
    }
  }
  return fmt::format("with a {} light in {} of {} comparisons{}", name_light(light), cheaper, all, where);
}

}  // namespace

records::TextTable make_comparison_table(const std::vector<CostChart>& charts) {
  records::TextTable table;
  if (charts.empty()) return table;
  const bool lights = charts.front().axis == CurveAxis::kLights;
  table.header = {lights ? "filter" : "prefiltered", lights ? "other filter" : "many taps", "where",
                  lights ? "lights compared" : "texels compared"};
  for (const LightMotion light : kBothLights)
    for (const char* is : {"cheaper", "dearer"})
      table.header.push_back(fmt::format("{}, the first is {} at", name_light(light), is));
  for (const CostChart& chart : charts) {
    for (const CurveComparison& each : compare_curves(chart)) {
      if (lights && !each.changes()) continue;
      std::vector<std::string>& row = table.rows.emplace_back(
          std::vector{chart.curves[each.a].label, chart.curves[each.b].label, chart.title, list_numbers(each.at)});
      for (const LightMotion light : kBothLights)
        for (const int sign : {-1, 1}) row.push_back(join_places(each, light, sign));
    }
  }
  return table;
}

records::TextTable make_light_table(const std::vector<CostChart>& charts) {
  const std::vector<double> counts = list_measured(charts);
  records::TextTable table;
  table.header = {"filter", "casters", "where"};
  for (const double count : counts) table.header.push_back(fmt::format("{} light{}", count, count == 1.0 ? "" : "s"));
  table.header.insert(table.header.end(),
                      {"ms per added light", "exponent", "off a line", "MiB of maps at the most lights"});
  for (const CostChart& chart : charts)
    for (const CostCurve& curve : chart.curves)
      for (const LightMotion light : kBothLights) table.rows.push_back(make_light_row(chart, curve, light, counts));
  return table;
}

records::TextTable make_growth_table(const std::vector<records::CellRecord>& cells) {
  records::TextTable table;
  table.header = {"filter"};
  for (const std::string& filter : list_filters(cells)) table.rows.push_back({filter});
  for (const Law& law : kLaws) {
    const auto series = list_series(cells, law);
    if (series.empty()) continue;
    table.header.push_back(describe_law(law, series));
    for (auto& row : table.rows) {
      const auto own = series.find(row.front());
      row.push_back(own == series.end() ? records::kNothing : describe_series(own->second));
    }
  }
  return table;
}

std::string summarize_widths(const std::vector<CostChart>& charts) {
  if (charts.empty()) return {};
  return fmt::format("A prefiltered map is cheaper than many taps {}; {}.",
                     summarize_light(charts, LightMotion::kStatic), summarize_light(charts, LightMotion::kMoving));
}

std::string summarize_lights(const std::vector<CostChart>& charts, const records::GlRecord& gl) {
  std::vector<std::pair<double, std::string>> slopes;
  std::size_t pairs = 0, changing = 0;
  for (const CostChart& chart : charts) {
    for (const CostCurve& curve : chart.curves)
      for (const LightMotion light : kBothLights)
        if (curve.points.size() > 1)
          slopes.push_back({find_light_growth(curve, light).per_light_ms.value,
                            fmt::format("{}, casters {}, {}", curve.label, name_light(light), chart.title)});
    for (const CurveComparison& each : compare_curves(chart)) {
      ++pairs;
      changing += each.changes();
    }
  }
  if (slopes.empty()) return {};
  const auto [least, most] = std::ranges::minmax(slopes);
  return fmt::format(
      "Each further light costs {} {} ({}) to {} ({}); {} of {} pairs of filters change order between numbers of "
      "lights, or between casters that stand still and that move.",
      records::format_number(least.first), records::time_unit(gl), least.second, records::format_number(most.first),
      most.second, changing, pairs);
}

}  // namespace shadowbench::analysis
