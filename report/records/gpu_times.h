#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>

#include "report/records/json_io.h"

namespace shadowbench::records {

/// What a cell's parts take on a GPU.
struct TimedParts {
  std::optional<OwnTime> map;  ///< none of a scene that was too large for the page to draw its map
  std::optional<OwnTime> prefilter;
  OwnTime filter;  ///< the lookup less its empty one
};

/// A file that a report's page saved, gpu-times.json: what a browser's GPU took for the run's cells.
struct GpuTimes {
  std::filesystem::path file;
  std::string renderer;
  bool software = false;                    ///< a rasteriser on the CPU
  std::map<std::string, TimedParts> cells;  ///< by key
};

/// Reads such a file, which may come from anywhere.
/// Throws Error(kInput) where it is larger than 16 MiB, no such file, or holds what is no time.
GpuTimes read_gpu_times(const std::filesystem::path& file);

/// Puts these times in the place of those that the run measured; cells that were not timed have none then.
/// Throws Error(kInput) where they are of another run: none of its cells was timed.
void apply_gpu_times(Results& results, const GpuTimes& times);

}  // namespace shadowbench::records
