#include <algorithm>
#include <array>

#include "report/document/blocks.h"
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

}  // namespace shadowbench::document
