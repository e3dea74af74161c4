#pragma once

#include <optional>
#include <vector>

#include "report/document/blocks.h"
#include "report/records/records.h"

namespace shadowbench::pages {

/// Errors and faults by cascade, and where cascades end in the terms of engines: a table and a chart for each scene and
/// fit. Nothing where no cell has cascades.
std::optional<document::Section> make_cascade_section(const std::vector<records::CellRecord>& cells);

}  // namespace shadowbench::pages
