#pragma once

#include <random>
#include <string>
#include <vector>

#include "report/records/records.h"

namespace shadowbench::analysis {

inline constexpr const char* kScenes[] = {"cubes", "stack", "fence"};

struct Made {
  const char* filter;
  double ms, rmse;
};

inline records::CellRecord make_picked(const Made& made, double reach = 0.0005, const char* scene = "cubes") {
  records::CellRecord cell;
  cell.scene = scene;
  cell.view = "main";
  cell.filter = made.filter;
  cell.status = records::CellStatus::kOk;
  cell.error.rmse = made.rmse;
  cell.rmse_ci95 = records::Interval{made.rmse - reach, made.rmse + reach};
  cell.time_ms.moving = records::OwnTime{{made.ms, made.ms, made.ms, 9}, {0.99 * made.ms, 1.01 * made.ms}};
  return cell;
}

/// A run that nobody measured: filters, maps, fits and scenes, some errors and costs equal, some absent.
inline std::vector<records::CellRecord> make_up_run(std::mt19937& random) {
  const auto draw = [&](int most) { return static_cast<int>(random() % static_cast<unsigned>(most)); };
  const int filters = 1 + draw(6), maps = 1 + draw(3), fits = 1 + draw(2), scenes = 1 + draw(3);
  std::vector<records::CellRecord> cells;
  for (int i = 0; i < filters * maps * fits; ++i) {
    const int filter = i % filters, map = i / filters % maps, fit = i / filters / maps;
    const double ms = (1 + draw(30)) * (1 + map), rmse = 0.002 * (1 + draw(40));
    for (int scene = 0; scene < scenes; ++scene) {
      const std::string name = filter == 0 ? "none" : std::string("f") + std::to_string(filter);
      records::CellRecord cell =
          make_picked({name.c_str(), ms, rmse * (1.0 + 0.1 * scene)}, 0.0005 * (1 + draw(4)), kScenes[scene]);
      cell.map_size = 512 << map;
      cell.fit = fit == 0 ? "tight" : "view";
      cell.artefact.leak = 0.01 * draw(20);
      if (draw(40) == 0) cell.error.rmse.reset();
      if (draw(40) == 0) cell.time_ms.moving.reset();
      if (draw(40) == 0) cell.status = records::CellStatus::kTimeout;
      if (draw(40) != 0) cells.push_back(std::move(cell));
    }
  }
  return cells;
}

}  // namespace shadowbench::analysis
