#pragma once

#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "report/records/json_io.h"

namespace shadowbench::records {

/// What a part takes on a GPU, ms.
struct TimedPart : OwnTime {
  std::optional<OwnTime> queries;  ///< what the browser's timer queries say: a cross-check, which no cost is made of
};

/// What a cell's parts take on a GPU.
struct TimedParts {
  std::optional<TimedPart> map;  ///< none of a scene that was too large for the page to draw its map
  std::optional<TimedPart> prefilter;
  TimedPart filter;  ///< the lookup less its empty one
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

/// Throws Error(kInput) where they are of another run: none of these cells was timed.
void require_times_of(const std::vector<CellRecord>& cells, const GpuTimes& times);

/// Puts these times in the place of those that the run measured; cells that were not timed have none then.
/// Throws Error(kInput) as require_times_of() does.
void apply_gpu_times(Results& results, const GpuTimes& times);

/// Writes them as the file has them, without what it says beside, for a page's script.
nlohmann::json gpu_times_json(const GpuTimes& times);

/// Where a report folder keeps times that were joined to it, those of this renderer.
std::filesystem::path gpu_times_path(const std::filesystem::path& report, const std::string& renderer);

/// Reads all that a report folder keeps, in the order of their files, but those that have none of its cells. What
/// cannot be read is left out, and `warnings` say why.
std::vector<GpuTimes> list_gpu_times(const std::filesystem::path& report, const std::vector<CellRecord>& cells,
                                     std::vector<std::string>& warnings);

}  // namespace shadowbench::records
