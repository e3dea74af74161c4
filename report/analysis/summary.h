#pragma once

#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "report/analysis/cell_group.h"
#include "report/records/records.h"

namespace shadowbench::analysis {

/// Says in plain sentences what a group's numbers show: times, which are those of `gl`, accuracy, and what went wrong.
/// Suspect cells are named for what is wrong with them, and left out of all else.
std::vector<std::string> describe_group(const CellGroup& group, const records::GlRecord& gl);

/// Lists the machine, the GL and the build, as name and value.
std::vector<std::pair<std::string, std::string>> list_run_facts(const records::RunRecord& run);

/// Counts, for every "field: reason" in the cells' `absent`, the cells that carry it.
std::map<std::string, int> count_absences(const std::vector<records::CellRecord>& cells);

}  // namespace shadowbench::analysis
