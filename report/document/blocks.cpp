#include "report/document/blocks.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "report/records/format.h"

namespace shadowbench::document {
namespace {

/// The place of a name in a list, at whose end it is put where it is new.
std::size_t find_or_add(std::vector<std::string>& names, const std::string& name) {
  const auto found = std::ranges::find(names, name);
  const auto place = static_cast<std::size_t>(found - names.begin());
  if (found == names.end()) names.push_back(name);
  return place;
}

}  // namespace

void Table::judge(const std::string& thing, const std::string& filter, std::string text, Grade grade) {
  std::vector<std::string> things;
  for (const auto& row : table.rows) things.push_back(row.front());
  const std::size_t row = find_or_add(things, thing), column = find_or_add(table.header, filter);
  table.rows.resize(things.size(), {thing});
  for (auto& fields : table.rows) fields.resize(table.header.size(), records::kNothing);
  grades.resize(things.size());
  for (auto& each : grades) each.resize(table.header.size(), Grade::kNone);
  if (table.rows[row][column] != records::kNothing) return;
  table.rows[row][column] = std::move(text);
  grades[row][column] = grade;
}

Grade Table::grade_at(std::size_t row, std::size_t column) const {
  return row < grades.size() && column < grades[row].size() ? grades[row][column] : Grade::kNone;
}

std::string Table::text_at(std::size_t row, std::size_t column) const {
  return (grade_at(row, column) == Grade::kBad ? "\u2717 " : "") + table.rows[row][column];
}

void show_most_telling(Chart& chart, std::vector<std::pair<double, std::string>> weights_and_titles) {
  std::ranges::stable_sort(weights_and_titles, std::ranges::greater(), &std::pair<double, std::string>::first);
  for (std::size_t i = kMostShown; i < weights_and_titles.size(); ++i)
    for (ChartSeries& series : chart.series)
      series.hidden = series.hidden || series.title == weights_and_titles[i].second;
  if (weights_and_titles.size() > kMostShown)
    chart.notes.emplace_back("pale in the key: hidden; click a name to show or hide its curve");
}

ChartStyle style_of(std::size_t filter) {
  static constexpr std::array kColors = {"#000000", "#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9"};
  static constexpr std::array kMarks = {Mark::kCircle, Mark::kSquare, Mark::kTriangle, Mark::kDiamond,
                                        Mark::kTriangleDown};
  return {kColors[filter % kColors.size()], kMarks[filter % kMarks.size()]};
}

namespace {

constexpr double kLogSpan = 3.0;
constexpr double kMargin = 0.06;  // of the axis, on each side
constexpr std::size_t kFewestTicks = 2, kMostTicks = 9;

std::string label_tick(double value, TickKind kind) {
  return kind == TickKind::kBytes ? analysis::format_value(analysis::list_cost_measures().back(), value)
                                  : fmt::format("{:.6g}", value);
}

std::vector<double> list_log_ticks(double low, double high, const std::vector<double>& digits) {
  std::vector<double> ticks;
  for (double power = std::pow(10.0, std::floor(std::log10(low))); power <= high; power *= 10.0) {
    for (const double digit : digits)
      if (digit * power >= low && digit * power <= high) ticks.push_back(digit * power);
  }
  return ticks;
}

std::vector<double> list_powers(double low, double high, double base) {
  std::vector<double> ticks;
  for (double tick = std::pow(base, std::ceil(std::log(low) / std::log(base) - 1e-9)); tick <= high; tick *= base)
    ticks.push_back(tick);
  return ticks;
}

std::vector<double> choose_log_ticks(double low, double high, TickKind kind) {
  const bool bytes = kind == TickKind::kBytes;
  for (const auto& ticks :
       bytes ? std::vector{list_powers(low, high, 2.0), list_powers(low, high, 4.0), list_powers(low, high, 16.0)}
             : std::vector{list_log_ticks(low, high, {1, 2, 3, 4, 5, 6, 7, 8, 9}),
                           list_log_ticks(low, high, {1, 2, 3, 5}), list_log_ticks(low, high, {1, 2, 5})})
    if (ticks.size() <= kMostTicks) return ticks;
  return list_powers(low, high, bytes ? 256.0 : 10.0);
}

std::vector<double> choose_linear_ticks(double low, double high) {
  const double rough = (high - low) / 6.0;
  const double power = std::pow(10.0, std::floor(std::log10(rough)));
  double step = 10.0 * power;
  for (const double digit : {5.0, 2.0, 1.0})
    if (digit * power >= rough) step = digit * power;
  std::vector<double> ticks;
  for (double k = std::ceil(low / step - 1e-9); k * step <= high * (1.0 + 1e-12); k += 1.0)
    ticks.push_back(k == 0.0 ? 0.0 : k * step);  // never -0
  return ticks;
}

ChartAxis choose_axis_from(const std::vector<double>& values, const std::vector<double>& ends, TickKind kind,
                           double log_span) {
  ChartAxis axis;
  if (values.empty()) return axis;
  const auto [smallest, largest] = std::minmax_element(values.begin(), values.end());
  double low = *smallest, high = *largest;
  axis.log = low > 0.0 && high / low >= log_span;
  for (const double end : ends) {
    if (axis.log && !(end > 0.0)) continue;
    low = std::min(low, axis.log ? std::max(end, low / kLogSpan) : end);
    high = std::max(high, end);
  }
  if (axis.log) {
    const double margin = std::max(1.02, std::pow(high / low, kMargin));
    axis.low = low / margin;
    axis.high = high * margin;
  } else {
    if (low >= 0.0 && low < 0.25 * high) low = 0.0;
    const double span = high > low ? high - low : std::max(std::abs(high), 1e-9);
    axis.low = low - kMargin * span;
    axis.high = high + kMargin * span;
  }
  std::vector<double> ticks = axis.log ? choose_log_ticks(axis.low, axis.high, kind) : std::vector<double>();
  if (ticks.size() < kFewestTicks) ticks = choose_linear_ticks(axis.low, axis.high);
  for (const double tick : ticks) axis.ticks.push_back({tick, label_tick(tick, kind)});
  return axis;
}

}  // namespace

ChartAxis choose_axis(const std::vector<double>& values, const std::vector<double>& ends, TickKind kind) {
  return choose_axis_from(values, ends, kind, kLogSpan);
}

ChartAxis choose_log_axis(const std::vector<double>& values, const std::vector<double>& ends) {
  return choose_axis_from(values, ends, TickKind::kNumber, 1.0);
}

}  // namespace shadowbench::document
