#pragma once

#include <optional>
#include <vector>

#include "harness/measure/map_traffic.h"
#include "harness/measure/scene_measurement.h"

namespace shadowbench::measure {

/// Counts what the lookups of a task's cells bring from memory into the last caches of the run's GPUs. It draws the
/// view's receivers anew, those of a frame of 1080 rows, whatever the size of the run's pictures: receivers of a small
/// picture share fewer lines of the map, and would count more for each. Where every second of them in each direction
/// still lies about a texel from the next, only these are asked.
class TrafficMeter {
 public:
  /// Everything but the task must outlive this object. `texels_per_pixel` is that of the run's pictures. Draws the
  /// view, and reads the map back.
  TrafficMeter(Renderer& renderer, const options::RunOptions& options, const SceneTask& task, SceneAssets& assets,
               std::optional<double> texels_per_pixel);

  /// Notes the bytes of one receiver's lookup, one number for each GPU; leaves the cell as it is where another process
  /// drew it, where the filter reads the map's samplers itself, or the view has no receiver. What a filter without a
  /// scalar model reads is counted: it is drawn again. Cost: a readback of the receivers, and count_map_traffic().
  void measure(MeasuredCell& cell);

 private:
  Renderer& renderer_;
  const options::RunOptions& options_;
  SceneTask task_;
  const LightMap& light_;
  int step_;  ///< every how many rows and columns of the frame are asked
  render::GBuffer gbuffer_;
  std::vector<CacheShape> caches_;
  std::vector<ModelLayer> layers_;

  std::vector<CountedLayer> count_reads(const MeasuredCell& cell);
};

}  // namespace shadowbench::measure
