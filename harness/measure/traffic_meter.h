#pragma once

#include <vector>

#include "harness/measure/map_traffic.h"
#include "harness/measure/scene_measurement.h"

namespace shadowbench::measure {

/// The rows of the receivers whose reads are counted, whatever the size of the run's pictures.
inline constexpr int kCountedRows = 540;
/// How many receivers of a frame of 1920x1080, which an estimate is for, each of them stands for.
inline constexpr int kReceiversOfOneCounted = 4;

/// Counts what the lookups of a task's cells bring from memory into the last caches of the run's GPUs. It draws the
/// view's receivers anew, as many as every fourth pixel of a frame of 1080 rows has: receivers of a small picture share
/// fewer lines of the map, and would count more for each.
class TrafficMeter {
 public:
  /// Everything but the task must outlive this object. Draws the view, and reads the map back.
  TrafficMeter(Renderer& renderer, const options::RunOptions& options, const SceneTask& task, SceneAssets& assets);

  /// Notes the bytes of one receiver's lookup, one number for each GPU; leaves the cell as it is where the filter has
  /// no scalar model, or the view no receiver. Cost: a readback of the receivers, and count_map_traffic().
  void measure(MeasuredCell& cell);

 private:
  Renderer& renderer_;
  const options::RunOptions& options_;
  SceneTask task_;
  const LightMap& light_;
  render::GBuffer gbuffer_;
  std::vector<CacheShape> caches_;
  std::vector<ModelLayer> layers_;
};

}  // namespace shadowbench::measure
