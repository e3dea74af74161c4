#pragma once

#include <optional>
#include <vector>

#include "filters/model.h"
#include "harness/measure/map_limits.h"
#include "harness/measure/scene_measurement.h"
#include "harness/render/filter_passes.h"

namespace shadowbench::measure {

/// Measures where the numbers of one task's cells break: in the encoded map as the GL made it, in visibility with the
/// 16-bit store against the 32-bit one, and where a bound is darker than what it bounds.
class StabilityMeter {
 public:
  /// Everything but the task must outlive this object.
  StabilityMeter(Renderer& renderer, const options::RunOptions& options, const SceneTask& task, SceneAssets& assets);

  /// Notes in the cell's warnings which limits its map exceeds, and what keeps them. Requires that the map was made.
  /// Cost: reads the map back; where a limit is exceeded also a map for each remedy that is tried.
  void warn(MeasuredCell& cell, render::FilterPasses& filter) const;

  /// Notes the cell's stability in its record, or why there is none, and leaves the maps as images.
  /// Requires that the cell was drawn. Cost: the map read back, some maps more for the safe exponent, map and lookup
  /// again with the other store, and for a bound its scalar model in two precisions and its brute-force
  /// percentage-closer filter.
  void measure(MeasuredCell& cell, render::FilterPasses& filter);

 private:
  Renderer& renderer_;
  const options::RunOptions& options_;
  SceneTask task_;
  SceneAssets& assets_;
  LightMap& light_;
  std::optional<std::vector<std::uint8_t>> mask_;

  MapTrial make_trial(const filters::FilterRequest& request) const;
  const std::vector<std::uint8_t>& mask();
  void check_texels(MeasuredCell& cell, render::FilterPasses& filter) const;
  images::Image draw_layers(render::FilterPasses& filter,
                            std::vector<float> (*of_layer)(const metrics::StoredMap&)) const;
  void compare_stores(MeasuredCell& cell);
  void check_bound(MeasuredCell& cell, render::FilterPasses& filter);
  metrics::BoundCheck compare_with_closer(const MeasuredCell& cell, const filters::ScalarModel& model,
                                          const render::LightLayers& light);
};

/// Names the store with as many channels and the other float precision; nothing where the filter does not offer
/// it.
std::optional<std::string> find_other_store(const filters::FilterRequest& request);

/// Draws where a cell's numbers break and notes the path in its record; nothing where it has no such images.
/// Throws Error(kOutput).
void write_stability(const options::RunOptions& options, const std::string& stem, MeasuredCell& cell);

}  // namespace shadowbench::measure
