#include "report/page/markdown_table.h"

#include <fmt/format.h>

#include <algorithm>

#include "report/page/markdown.h"
#include "report/records/text_table.h"

namespace shadowbench::page {
namespace {

/// Counts characters as a terminal shows them: bytes of UTF-8 that begin one.
std::size_t shown_width(const std::string& text) {
  return static_cast<std::size_t>(std::count_if(
      text.begin(), text.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xC0u) != 0x80u; }));
}

}  // namespace

std::string make_markdown_table(const records::TextTable& table) {
  std::vector<std::size_t> widths(table.header.size(), 3);
  std::vector<std::vector<std::string>> rows = {table.header};
  rows.insert(rows.end(), table.rows.begin(), table.rows.end());
  for (const auto& row : rows)
    for (std::size_t i = 0; i < row.size(); ++i) widths[i] = std::max(widths[i], shown_width(row[i]));
  std::string text;
  for (std::size_t r = 0; r < rows.size(); ++r) {
    for (std::size_t i = 0; i < widths.size(); ++i)
      text += fmt::format("| {}{:{}}", rows[r][i], "", widths[i] - shown_width(rows[r][i]) + 1);
    text += "|\n";
    if (r > 0) continue;
    for (const std::size_t width : widths) text += fmt::format("|{:-<{}}", "", width + 2);
    text += "|\n";
  }
  return text + "\n";
}

}  // namespace shadowbench::page
