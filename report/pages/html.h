#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "report/records/records.h"

namespace shadowbench::pages {

/// Makes index.html: one page that opens from disk and loads nothing but the report's own pictures, by relative links.
/// Holds the run's facts, warnings, per group of comparable cells its sentences, tables, bars of the error's parts,
/// grid, pictures of these parts, single pictures and depth map, links to the data files, and what is absent and why.
/// `trade` is a section that goes before the groups (make_trade_html()), or empty.
std::string make_index_html(const records::RunRecord& run, const std::vector<records::CellRecord>& cells,
                            const std::string& trade = {});

}  // namespace shadowbench::pages
