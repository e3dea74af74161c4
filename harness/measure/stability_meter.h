#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "filters/catalogue.h"
#include "filters/model.h"
#include "harness/measure/scene_measurement.h"
#include "harness/render/filter_passes.h"
#include "reference/metrics/map_stability.h"

namespace shadowbench::measure {

/// Makes a filter's encoded map with other parameters, and gives the health of its texels.
using MapTrial = std::function<metrics::TexelHealth(const filters::ParamValues&)>;

/// Counts the texels of a filter's encoded map that overflowed or are NaN; 0 for filters that read depth. Requires that
/// its map was made.
std::int64_t count_broken_texels(render::FilterPasses& filter, const render::ShadowMap& map);

/// Finds the largest value, within the parameter's range, of the filter's exponent with which its map does not
/// overflow: the logarithm of the largest stored number is proportional to it, and the result is tried. Rounded down to
/// four digits. Nothing for a filter without an exponent, for a map of logarithms, and where nothing stored exceeds 1.
/// Cost: about four trials.
std::optional<double> find_safe_exponent(const filters::FilterRequest& request, const MapTrial& trial);

/// Which limits a filter's map exceeds, and which parameters, each tried, keep them: infinite or NaN texels, and
/// variances that rounding takes below 0 by more than the filter's `variance_floor` makes up for. `name` begins every
/// line.
std::vector<std::string> list_exceeded_limits(const std::string& name, const filters::FilterRequest& request,
                                              const metrics::TexelHealth& health, const MapTrial& trial);

/// Measures where the numbers of one task's cells break: in the encoded map as the GL made it, in visibility with the
/// 16-bit store against the 32-bit one, and where a bound is darker than what it bounds.
class StabilityMeter {
 public:
  explicit StabilityMeter(const TaskRig& rig) : rig_(rig), light_(rig.light()) {}

  /// Notes in the cell's warnings which limits its map exceeds, and what keeps them. Requires that the map was made.
  /// Cost: reads the map back; where a limit is exceeded also a map for each remedy that is tried.
  void warn(MeasuredCell& cell, render::FilterPasses& filter) const;

  /// Notes the cell's stability in its record, or why there is none, and leaves the maps as images.
  /// Requires that the cell was drawn. Cost: the map read back, some maps more for the safe exponent, map and lookup
  /// again with the other store, and for a bound its scalar model in two precisions and its brute-force
  /// percentage-closer filter.
  void measure(MeasuredCell& cell, render::FilterPasses& filter);

 private:
  TaskRig rig_;
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

/// Draws where a cell's numbers break and notes the path in its record; nothing where it has no such images.
/// Throws Error(kOutput).
void write_stability(const options::RunOptions& options, const std::string& stem, MeasuredCell& cell);

}  // namespace shadowbench::measure
