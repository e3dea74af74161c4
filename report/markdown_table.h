#pragma once

#include <string>

#include "report/text_tables.h"

namespace shadowbench::report {

/// Writes a Markdown table of escaped texts, whose columns line up, for terminals, and an empty line.
std::string make_markdown_table(const TextTable& table);

}  // namespace shadowbench::report
