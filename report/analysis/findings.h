#pragma once

#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "report/analysis/cells.h"
#include "report/records/records.h"

namespace shadowbench::analysis {

/// Says how small a difference between two filters' RMSEs a run can tell apart, with 95 % confidence and a power of
/// 80 %: of one class of width, in one place. Empty where no two cells have phases in common.
std::string describe_power(const std::vector<records::CellRecord>& cells);

/// Says in a sentence for each trouble what breaks in a group's cells: broken texels, with the exponent that would be
/// safe, variances below 0, a bound that does not hold, a 16-bit store that shows. Nothing where nothing breaks, or
/// where the run was made without stability maps.
std::vector<std::string> describe_stability(const CellGroup& group);

/// Write the captions of the parts of a cell's stability picture; empty where there is nothing to say.
std::string caption_texels(const records::CellRecord& cell);
std::string caption_variance(const records::CellRecord& cell);
std::string caption_difference(const records::CellRecord& cell);
std::string caption_bound(const records::CellRecord& cell);

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
