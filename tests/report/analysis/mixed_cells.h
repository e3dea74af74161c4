#pragma once

#include <string>
#include <vector>

#include "tests/report/analysis/trade_cells.h"

namespace shadowbench::analysis {

inline records::MachineKind make_kind(const std::string& cpu) { return {cpu, 4, "A rasteriser"}; }

/// That cell, measured on another kind of machine, on which everything takes `times` as long.
inline records::CellRecord move_to(records::CellRecord cell, const records::MachineKind& kind, double times) {
  const auto scale = [&](auto& time) {
    if (!time) return;
    for (double* value : {&time->median, &time->q1, &time->q3}) *value *= times;
  };
  for (auto member : {&records::TimeRecord::map, &records::TimeRecord::prefilter, &records::TimeRecord::lookup,
                      &records::TimeRecord::empty})
    scale(cell.time_ms.*member);
  for (auto member : {&records::TimeRecord::static_light, &records::TimeRecord::moving}) {
    scale(cell.time_ms.*member);
    if (!(cell.time_ms.*member)) continue;
    (cell.time_ms.*member)->ci95.low *= times;
    (cell.time_ms.*member)->ci95.high *= times;
  }
  cell.machine = kind;
  return cell;
}

/// `none`, a filter of twice its cost on the same slow machine, and one of three times its cost, of the same error, on
/// a machine that is a hundred times as fast.
inline std::vector<records::CellRecord> make_mixed_cells() {
  const records::MachineKind slow = make_kind("A slow CPU");
  const records::MachineKind fast{"A fast CPU", 64, "A GPU", false, records::TimerKind::kTimerQuery};
  return {move_to(make_sweep_cell({"cubes", "none", 1.0, 1.0, 0.0, 0.1}), slow, 10.0),
          move_to(make_sweep_cell({"cubes", "slow", 1.0, 2.0, 0.01, 0.05}), slow, 10.0),
          move_to(make_sweep_cell({"cubes", "fast", 1.0, 3.0, 0.01, 0.05}), fast, 0.1)};
}

}  // namespace shadowbench::analysis
