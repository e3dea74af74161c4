#pragma once

#include <string>

#include "report/records/text_table.h"

namespace shadowbench::page {

/// Writes a Markdown table of escaped texts, whose columns line up, for terminals, and an empty line.
std::string make_markdown_table(const records::TextTable& table);

}  // namespace shadowbench::page
