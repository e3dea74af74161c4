#include "report/page/markdown.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "report/records/text_table.h"

namespace shadowbench::page {
namespace {

std::string markdown_row(const std::vector<std::string>& fields) {
  std::vector<std::string> escaped(fields.size());
  std::transform(fields.begin(), fields.end(), escaped.begin(), escape_markdown);
  return fmt::format("| {} |\n", fmt::join(escaped, " | "));
}

}  // namespace

std::string escape_markdown(std::string_view text) {
  std::string escaped;
  for (const char c : text) {
    if (c == '\n' || c == '\r') {
      escaped += ' ';
      continue;
    }
    if (std::string_view("\\`*_[]<>|#~").find(c) != std::string_view::npos) escaped += '\\';
    escaped += c;
  }
  return escaped;
}

std::string markdown_table(const records::TextTable& table) {
  std::string text = markdown_row(table.header) + "|";
  for (std::size_t i = 0; i < table.header.size(); ++i) text += "---|";
  text += "\n";
  for (const auto& row : table.rows) text += markdown_row(row);
  return text;
}

}  // namespace shadowbench::page
