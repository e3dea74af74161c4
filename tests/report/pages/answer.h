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

/// The first block of a kind for which `matches` holds, folded ones included; null where there is none.
template <typename Kind>
const Kind* find_block(
    const std::vector<Block>& blocks,
    const std::function<bool(const Kind&)>& matches = [](const Kind&) { return true; }) {
  for (const Block& block : blocks) {
    if (const auto* own = std::get_if<Kind>(&block); own && matches(*own)) return own;
    const auto* details = std::get_if<Details>(&block);
    if (const Kind* inside = details ? find_block<Kind>(details->blocks, matches) : nullptr) return inside;
  }
  return nullptr;
}

/// What a section's first table says of a thing under a filter, and its grade.
inline std::pair<std::string, Grade> verdict_of(const Page& page, const std::string& thing, const std::string& filter,
                                                const std::string& id = "answer") {
  const Table& table = *find_block<Table>(std::ranges::find(page.sections, id, &Section::id)->blocks);
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

/// The text of the script element with this id.
inline std::string read_script(const std::string& page, const std::string& id) {
  const std::size_t begin = page.find('>', page.find("id=\"" + id + "\"")) + 1;
  return page.substr(begin, page.find("</script>", begin) - begin);
}

}  // namespace shadowbench::pages
