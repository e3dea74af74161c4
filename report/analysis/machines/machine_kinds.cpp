#include "report/analysis/machines/machine_kinds.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "report/records/format.h"

namespace shadowbench::analysis {
namespace {

constexpr const char* kWithheld =
    "several kinds of machine measured the run, whose times do not compare; see ratio_to_none";

void withhold_times(records::CellRecord& cell) {
  std::erase_if(cell.absent,
                [](const auto& entry) { return entry.first == "time_ms" || entry.first.starts_with("time_ms."); });
  cell.time_ms = {};
  cell.absent["time_ms"] = kWithheld;
  if (!cell.lights) return;
  cell.lights.reset();
  cell.absent["lights"] = kWithheld;
}

}  // namespace

std::vector<MachineCount> count_machines(const std::vector<records::CellRecord>& cells) {
  std::vector<MachineCount> machines;
  for (const records::CellRecord& cell : cells) {
    auto known = std::ranges::find(machines, cell.machine, &MachineCount::kind);
    if (known == machines.end()) known = machines.insert(known, {cell.machine, 0});
    ++known->cells;
  }
  return machines;
}

bool mixes_machines(const std::vector<records::CellRecord>& cells) {
  return std::ranges::any_of(
      cells, [&](const records::CellRecord& cell) { return cell.machine != cells.front().machine; });
}

std::string describe_machine(const MachineCount& machine) {
  return fmt::format("{} ({} cell{})",
                     machine.kind ? records::describe_machine_kind(*machine.kind) : "one that the cells do not name",
                     machine.cells, machine.cells == 1 ? "" : "s");
}

std::string warn_of_mixed_machines(const std::vector<MachineCount>& machines) {
  std::vector<std::string> kinds;
  for (const MachineCount& each : machines)
    kinds.push_back(fmt::format("machine {} is {}", kinds.size() + 1, describe_machine(each)));
  return fmt::format(
      "{}: {}. Times of two kinds do not compare. What a filter costs is therefore said as its ratio to 'none', which "
      "was timed in the same rounds on the same machine; what needs milliseconds (charts over lights and maps) is "
      "left out. Milliseconds stand in the tables of each scene and in timings.csv, "
      "with their machine.",
      kMixedMachines, fmt::join(kinds, "; "));
}

std::optional<std::vector<records::CellRecord>> withhold_mixed_times(const std::vector<records::CellRecord>& cells) {
  if (!mixes_machines(cells)) return std::nullopt;
  std::vector<records::CellRecord> without = cells;
  for (records::CellRecord& cell : without) withhold_times(cell);
  return without;
}

CostKind frame_cost_kind(const std::vector<records::CellRecord>& cells) {
  return mixes_machines(cells) ? CostKind::kRatio : CostKind::kTime;
}

}  // namespace shadowbench::analysis
