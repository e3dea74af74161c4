#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "report/analysis/limits.h"
#include "report/records/records.h"

namespace shadowbench::analysis {

/// A kind of machine, and how many cells it measured. Cells of before do not know theirs, and count as one kind.
struct MachineCount {
  std::optional<records::MachineKind> kind;
  std::size_t cells = 0;
};

/// Counts the cells of each kind of machine, in the order in which the kinds first appear.
std::vector<MachineCount> count_machines(const std::vector<records::CellRecord>& cells);

/// Whether several kinds of machine measured the cells, so that their times do not compare.
bool mixes_machines(const std::vector<records::CellRecord>& cells);

/// Names a kind for people, also one that is not known, with the number of its cells.
std::string describe_machine(const MachineCount& machine);

/// The beginning of the warning below.
inline constexpr std::string_view kMixedMachines = "Several kinds of machine measured the cells";

/// Says which kinds measured the cells, numbered from 1 as in tables, and what follows from that. Requires several.
std::string warn_of_mixed_machines(const std::vector<MachineCount>& machines);

/// Returns a copy of the cells without times of any kind where several kinds of machine measured them; `absent` says
/// why. Nothing where one kind did: then the cells compare as they are. Ratios to `none` stay, for each was timed in
/// the same rounds as its `none`. The copy's cells are in the same order.
std::optional<std::vector<records::CellRecord>> withhold_mixed_times(const std::vector<records::CellRecord>& cells);

/// Returns what the time of a frame is compared by: milliseconds, or the ratio to `none` where machines are mixed.
CostKind frame_cost_kind(const std::vector<records::CellRecord>& cells);

}  // namespace shadowbench::analysis
