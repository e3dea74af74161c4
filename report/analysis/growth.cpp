#include "report/analysis/growth.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <tuple>

#include "report/analysis/summary.h"
#include "report/analysis/trade.h"
#include "report/records/cell_key.h"
#include "report/records/format.h"
#include "report/records/json_values.h"

namespace shadowbench::analysis {
namespace {

using Point = std::pair<double, double>;

double size_of(const records::CellRecord& cell, GrowthLaw law) {
  if (law == GrowthLaw::kLookupOverPixels) return static_cast<double>(cell.width) * cell.height;
  return static_cast<double>(cell.map_size) * cell.map_size;
}

std::optional<double> time_of(const records::CellRecord& cell, GrowthLaw law) {
  const auto& time = law == GrowthLaw::kPrefilterOverTexels ? cell.time_ms.prefilter : cell.time_ms.lookup;
  return time && time->median > 0.0 ? std::optional(time->median) : std::nullopt;
}

std::string series_key(const records::CellRecord& cell, GrowthLaw law) {
  auto settings = records::cell_settings(cell);
  settings.erase(law == GrowthLaw::kLookupOverPixels ? "size" : "map_size");
  return records::dump_line(settings);
}

std::vector<std::vector<Point>> list_series(const std::vector<records::CellRecord>& cells, const std::string& filter,
                                            GrowthLaw law) {
  std::map<std::string, std::vector<Point>> series;
  for (const records::CellRecord& cell : cells) {
    const auto time = time_of(cell, law);
    if (cell.filter == filter && time && size_of(cell, law) > 0.0)
      series[series_key(cell, law)].push_back({size_of(cell, law), *time});
  }
  std::vector<std::vector<Point>> result;
  for (auto& [key, points] : series) {
    std::sort(points.begin(), points.end());
    if (points.front().first < points.back().first) result.push_back(points);
  }
  return result;
}

std::optional<Growth> find_growth_of(const std::vector<records::CellRecord>& cells, const std::string& filter,
                                     GrowthLaw law) {
  const auto series = list_series(cells, filter, law);
  if (series.empty()) return std::nullopt;
  std::vector<double> exponents;
  Growth growth{
      filter, 0.0, 0.0, 0.0, static_cast<int>(series.size()), series[0].front().first, series[0].back().first};
  for (const auto& points : series) {
    exponents.push_back(fit_exponent(points));
    growth.from = std::min(growth.from, points.front().first);
    growth.to = std::max(growth.to, points.back().first);
  }
  std::sort(exponents.begin(), exponents.end());
  const std::size_t middle = exponents.size() / 2;
  growth.exponent = exponents.size() % 2 == 1 ? exponents[middle] : 0.5 * (exponents[middle - 1] + exponents[middle]);
  growth.lowest = exponents.front();
  growth.highest = exponents.back();
  return growth;
}

std::string format_exponent(double exponent) {
  return fmt::format("{:.2f}", std::abs(exponent) < 0.005 ? 0.0 : exponent);
}

std::string describe_one(const Growth& growth) {
  const std::string range = growth.series > 1 ? fmt::format(", {} to {} in {} series", format_exponent(growth.lowest),
                                                            format_exponent(growth.highest), growth.series)
                                              : std::string();
  return fmt::format("{} {}{}", growth.filter, format_exponent(growth.exponent), range);
}

std::string describe_law(const std::vector<Growth>& growths, const char* what, const char* size) {
  double from = growths[0].from, to = growths[0].to;
  std::vector<std::string> parts;
  for (const Growth& each : growths) {
    from = std::min(from, each.from);
    to = std::max(to, each.to);
    parts.push_back(describe_one(each));
  }
  return fmt::format("{}, from {} to {}, to the power of (1 would be in proportion, 0 not at all): {}.", what,
                     records::format_number(from), fmt::format("{} {}", records::format_number(to), size),
                     fmt::join(parts, "; "));
}

}  // namespace

double fit_exponent(const std::vector<Point>& points) {
  double x = 0.0, y = 0.0, xx = 0.0, xy = 0.0;
  for (const auto& [size, time] : points) {
    x += std::log(size);
    y += std::log(time);
  }
  const double count = static_cast<double>(points.size());
  x /= count;
  y /= count;
  for (const auto& [size, time] : points) {
    xx += (std::log(size) - x) * (std::log(size) - x);
    xy += (std::log(size) - x) * (std::log(time) - y);
  }
  return xy / xx;
}

std::vector<Growth> find_growth(const std::vector<records::CellRecord>& cells, GrowthLaw law) {
  std::vector<Growth> growths;
  for (const std::string& filter : list_filters(cells))
    if (const auto growth = find_growth_of(cells, filter, law)) growths.push_back(*growth);
  return growths;
}

std::vector<std::string> describe_growth(const std::vector<records::CellRecord>& cells) {
  const std::tuple<GrowthLaw, const char*, const char*> laws[] = {
      {GrowthLaw::kLookupOverPixels, "Time of the lookup grows with the picture", "pixels"},
      {GrowthLaw::kLookupOverTexels, "Time of the lookup grows with the map", "texels"},
      {GrowthLaw::kPrefilterOverTexels, "Time of the prefilter grows with the map", "texels"}};
  std::vector<std::string> sentences;
  for (const auto& [law, what, size] : laws) {
    const auto growths = find_growth(cells, law);
    if (!growths.empty()) sentences.push_back(describe_law(growths, what, size));
  }
  return sentences;
}

}  // namespace shadowbench::analysis
