#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "report/records/csv_tables.h"

namespace shadowbench::document {

/// Escapes a text so that Markdown shows it as it is, also in a table's field.
std::string escape_markdown(std::string_view text);

/// Whether a table's field begins like a number.
bool is_number_like(std::string_view field);

/// Counts characters as a terminal shows them: bytes of UTF-8 that begin one.
std::size_t count_shown(std::string_view text);

/// Breaks a paragraph at spaces into lines of so many columns. `begin` of the first line are taken; the others are
/// indented.
std::string wrap(std::string_view paragraph, std::size_t columns, std::size_t indent, std::size_t begin = 0);

/// Writes a Markdown table whose columns line up, for terminals too, and an empty line. Escapes its texts.
std::string write_markdown_table(const records::TextTable& table);

}  // namespace shadowbench::document
