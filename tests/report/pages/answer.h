#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <utility>

#include "report/document/blocks.h"
#include "report/pages/write_page.h"
#include "report/records/json_io.h"
#include "tests/test_files.h"

namespace shadowbench::document {

/// What a page says first.
inline std::string answer_of(const Page& page) { return std::get<Paragraph>(page.sections.at(0).blocks.at(0)).text; }

/// The first table of blocks, folded ones included; null where there is none.
inline const Table* find_table(const std::vector<Block>& blocks) {
  for (const Block& block : blocks) {
    if (const auto* table = std::get_if<Table>(&block)) return table;
    const auto* details = std::get_if<Details>(&block);
    if (const Table* inside = details ? find_table(details->blocks) : nullptr) return inside;
  }
  return nullptr;
}

/// What a section's first table says of a thing under a filter, and its grade.
inline std::pair<std::string, Grade> verdict_of(const Page& page, const std::string& thing, const std::string& filter,
                                                const std::string& id = "answer") {
  const Table& table = *find_table(std::ranges::find(page.sections, id, &Section::id)->blocks);
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

namespace shadowbench::pages {

/// Writes the report of some cells, and reads one of its files.
inline std::string write_and_read(const TestFolder& folder, const records::RunRecord& run,
                                  const std::vector<records::CellRecord>& cells, const std::string& file) {
  std::vector<std::string> keys;
  for (const records::CellRecord& cell : cells) {
    records::write_cell(folder.path(), cell);
    keys.push_back(cell.key);
  }
  write_report(folder.path(), run, keys);
  return folder.read(file);
}

}  // namespace shadowbench::pages
