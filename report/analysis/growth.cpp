#include "report/analysis/growth.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>

#include "report/analysis/trade.h"
#include "report/records/cell_key.h"
#include "report/records/format.h"
#include "report/records/json_values.h"

namespace shadowbench::analysis {
namespace {

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

std::string format_exponent(double exponent) {
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
  if (exponents.size() == 1) return format_exponent(median);
  return fmt::format("{}, {} to {} in {} series", format_exponent(median), format_exponent(exponents.front()),
                     format_exponent(exponents.back()), exponents.size());
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

}  // namespace

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

double fit_exponent(Points points) {
  for (auto& [size, time] : points) {
    size = std::log(size);
    time = std::log(time);
  }
  return fit_slope(points);
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

}  // namespace shadowbench::analysis
