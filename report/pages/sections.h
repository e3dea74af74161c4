#pragma once

#include <optional>
#include <vector>

#include "report/document/blocks.h"
#include "report/records/records.h"

namespace shadowbench::pages {

/// Errors and faults by cascade, and where cascades end in the terms of engines: a table and a chart for each scene and
/// fit. Nothing where no cell has cascades.
std::optional<document::Section> make_cascade_section(const std::vector<records::CellRecord>& cells);

/// What other renderers drew, held against the run's filters; nothing where the run has no such rows.
std::optional<document::Section> make_external_section(const std::vector<records::CellRecord>& cells);

/// What drew a row: "three.js r187 · map 1024 · bias -0.005"; empty where its user said nothing.
std::string describe_engine(const records::ExternalRecord& external);

}  // namespace shadowbench::pages
