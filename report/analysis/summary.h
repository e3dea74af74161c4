#pragma once

#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "report/records/records.h"

namespace shadowbench::analysis {

/// Lists the machine, the GL and the build, as name and value.
std::vector<std::pair<std::string, std::string>> list_run_facts(const records::RunRecord& run);

/// The beginning of the warning below.
inline constexpr std::string_view kMixedMachines = "Several kinds of machine measured the cells";

/// Warns that times are left out, and names the kinds of machine with the number of their cells. Requires
/// mixes_machines().
std::string warn_of_mixed_machines(const std::vector<records::CellRecord>& cells);

/// Counts, for every "field: reason" in the cells' `absent`, the cells that carry it.
std::map<std::string, int> count_absences(const std::vector<records::CellRecord>& cells);

}  // namespace shadowbench::analysis
