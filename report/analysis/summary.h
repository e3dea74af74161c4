#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "report/analysis/machines/machine_kinds.h"
#include "report/records/records.h"

namespace shadowbench::analysis {

/// Lists the machine, the GL and the build, as name and value; where several kinds of machine measured the cells,
/// each of `machines` with its cells.
std::vector<std::pair<std::string, std::string>> list_run_facts(const records::RunRecord& run,
                                                                const std::vector<MachineCount>& machines = {});

/// Counts, for every "field: reason" in the cells' `absent`, the cells that carry it.
std::map<std::string, int> count_absences(const std::vector<records::CellRecord>& cells);

}  // namespace shadowbench::analysis
