#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "filters/catalogue.h"
#include "harness/render/filter_passes.h"
#include "reference/metrics/map_stability.h"

namespace shadowbench::measure {

/// Makes a filter's encoded map with other parameters, and gives the health of its texels.
using MapTrial = std::function<metrics::TexelHealth(const filters::ParamValues&)>;

/// A filter's encoded map as it was read back, in the terms of metrics::check_texels.
class ReadMap {
 public:
  /// Reads the map of a filter back, of a 16-bit float store before its blur, too: there a GL may saturate, and the
  /// blur hides it. Requires a filter that encodes, and that its map was made.
  ReadMap(render::FilterPasses& filter, const render::ShadowMap& map, int layer = 0);

  /// What is looked at; the object must outlive it.
  metrics::StoredMap stored() const;

  int side() const { return texels_.side; }

 private:
  filters::FilterRequest request_;
  render::EncodedTexels texels_;
  std::optional<render::EncodedTexels> before_blur_;
  int radius_ = 0;
  std::optional<glm::vec4> border_;
};

/// Looks through all layers of a filter's encoded map. Requires a filter that encodes, and that its map was made.
metrics::TexelHealth check_map(render::FilterPasses& filter, const render::ShadowMap& map);

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

}  // namespace shadowbench::measure
