#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <utility>

#include "report/document/blocks.h"

namespace shadowbench::document {

/// What a page says first.
inline std::string answer_of(const Page& page) { return std::get<Paragraph>(page.sections.at(0).blocks.at(0)).text; }

/// The table below that: what it says of a thing under a filter, and its grade.
inline std::pair<std::string, Grade> verdict_of(const Page& page, const std::string& thing, const std::string& filter) {
  const Table& table = std::get<Table>(page.sections.at(0).blocks.at(1));
  const auto column = std::ranges::find(table.table.header, filter) - table.table.header.begin();
  for (std::size_t r = 0; r < table.table.rows.size(); ++r)
    if (table.table.rows[r][0].starts_with(thing) && column < std::ssize(table.table.header))
      return {table.text_at(r, static_cast<std::size_t>(column)), table.grade_at(r, static_cast<std::size_t>(column))};
  ADD_FAILURE() << "no row " << thing << ", or no column " << filter;
  return {};
}

/// The names of the curves that are there before one clicks the key.
inline std::vector<std::string> list_shown(const Chart& chart) {
  std::vector<std::string> titles;
  for (const ChartSeries& series : chart.series)
    if (!series.title.empty() && !series.hidden) titles.push_back(series.title);
  return titles;
}

}  // namespace shadowbench::document
