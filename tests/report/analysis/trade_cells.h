#pragma once

#include "tests/report/records/synthetic.h"

namespace shadowbench::analysis {

/// A cell of a sweep that costs 4 ms times `ratio`, the light moving or still, known to `slack` of itself.
struct SweepCell {
  std::string scene = "cubes";
  std::string filter = "none";
  double radius = 0.0;
  double ratio = 1.0;
  double slack = 0.0;
  double rmse = 0.1;
  int map_size = 1024;
};

inline records::CellRecord make_sweep_cell(const SweepCell& from) {
  records::CellRecord cell = records::make_scored_cell(from.scene, from.filter, 4.0 * from.ratio, from.rmse);
  cell.params = {{"radius", from.radius}};
  cell.map_size = from.map_size;
  cell.kernel_radius_texels = cell.kernel.sigma_texels = from.radius;
  cell.time_ms.map = records::Quartiles{4.0, 4.0, 4.0, 9};
  const records::Ratio ratio{from.ratio, {from.ratio * (1.0 - from.slack), from.ratio * (1.0 + from.slack)}};
  cell.ratio_to_none.lookup = cell.ratio_to_none.static_light = cell.ratio_to_none.moving = ratio;
  const double ms = 4.0 * from.ratio, reach = ms * from.slack;
  cell.time_ms.static_light = cell.time_ms.moving =
      records::OwnTime{{ms, ms - reach, ms + reach, 9}, {ms - reach, ms + reach}};
  cell.absent.clear();
  cell.key = records::cell_key(cell);
  return cell;
}

/// A prefiltered cell whose time does not follow from its radius, and one of taps whose time does.
inline records::CellRecord make_blurred_cell(const std::string& scene, double radius, double ratio) {
  records::CellRecord cell = make_sweep_cell({scene, "vsm", radius, ratio, 0.01, 0.05});
  cell.cost.prefilter_texels = 4096;
  cell.cost.fetches = 1.0;
  return cell;
}

inline records::CellRecord make_taps_cell(const std::string& scene, double radius, double ratio) {
  records::CellRecord cell = make_sweep_cell({scene, "poisson", radius, ratio, 0.01, 0.06});
  cell.cost.fetches = 16.0;
  return cell;
}

/// Taps grow dearer than the blurred map between the radii 2 and 4.
inline std::vector<records::CellRecord> make_crossing_cells(const std::string& scene) {
  return {make_sweep_cell({scene}),          make_taps_cell(scene, 2.0, 1.6),    make_taps_cell(scene, 4.0, 2.5),
          make_taps_cell(scene, 8.0, 5.0),   make_blurred_cell(scene, 2.0, 2.0), make_blurred_cell(scene, 4.0, 2.0),
          make_blurred_cell(scene, 8.0, 2.0)};
}

inline records::MachineKind make_kind(const std::string& cpu) { return {cpu, 4, "A rasteriser"}; }

/// `none` and a filter on one machine, and another filter of the same error on a faster one.
inline std::vector<records::CellRecord> make_mixed_cells() {
  std::vector<records::CellRecord> cells = {make_sweep_cell({"cubes", "none", 1.0, 10.0, 0.0, 0.1}),
                                            make_sweep_cell({"cubes", "slow", 1.0, 20.0, 0.01, 0.05}),
                                            make_sweep_cell({"cubes", "fast", 1.0, 0.3, 0.01, 0.05})};
  cells[0].machine = cells[1].machine = make_kind("A slow CPU");
  cells[2].machine = {"A fast CPU", 64, "A GPU", false, records::TimerKind::kTimerQuery};
  return cells;
}

}  // namespace shadowbench::analysis
