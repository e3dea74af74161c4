#pragma once

#include <iterator>
#include <optional>
#include <string>
#include <vector>

#include "report/analysis/cells.h"
#include "report/records/csv_tables.h"
#include "report/records/records.h"

namespace shadowbench::analysis {

/// What one configuration costs on one GPU: facts and bounds of its first cell, and the means of the estimates over its
/// cells.
struct GpuCost {
  const Configuration* configuration = nullptr;
  const records::GpuRecord* record = nullptr;
  std::optional<double> estimate_ms;  ///< of a frame, moving light; nothing where a cell has none
  double lookup_ms = 0.0, prefilter_ms = 0.0, map_ms = 0.0;  ///< the parts of it
  /// With a moving light, in the run's clock; nothing where a cell has none, or a software rasteriser drew it: a CPU's
  /// times say nothing of a GPU.
  std::optional<double> measured_ms;
};

/// The costs of all configurations that have a record of the GPU and are right everywhere.
std::vector<GpuCost> list_gpu_costs(const std::vector<Configuration>& configurations, const std::string& gpu);

/// Says what was refused or guessed.
std::vector<std::string> describe_gpu(const std::string& gpu, const std::vector<GpuCost>& costs);

/// One row for each configuration that the GPU's compiler took: the estimate, beside the time of the GPU that drew the
/// run if one did, and facts of its lookup minus those of the empty one.
records::TextTable make_gpu_table(const std::vector<GpuCost>& costs);

}  // namespace shadowbench::analysis
