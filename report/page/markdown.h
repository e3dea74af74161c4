#pragma once

#include <string>
#include <string_view>

#include "report/records/text_table.h"

namespace shadowbench::page {

/// Escapes a text so that Markdown shows it as it is, also in a table's field.
std::string escape_markdown(std::string_view text);

/// Writes a table as Markdown.
std::string markdown_table(const records::TextTable& table);

}  // namespace shadowbench::page
