#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "filters/filter_spec.h"
#include "filters/tracked.h"

namespace shadowbench::filters {

/// A depth map as read back from the GL; row 0 is v = 0, depth in [0,1].
struct DepthMap {
  int size = 0;              ///< texels per side
  std::vector<float> depth;  ///< size * size
  /// Fixed-point formats clamp the reference of a comparison to [0,1], float formats do not (OpenGL 4.5, section 8.23).
  bool clamps_reference = false;
  /// Comparisons of values this near are decided by rounding, in addition to one ULP of the reference.
  float tie = 0.0f;

  /// Gives the depth that a comparison with `z` uses.
  float reference(float z) const { return clamps_reference ? std::clamp(z, 0.0f, 1.0f) : z; }
};

/// Everything a model may look at besides the receiver.
struct ModelInput {
  const FilterSpec& spec;
  const ParamValues& values;  ///< complete
  const DepthMap& map;        ///< must outlive what is prepared from it
  GlAccuracy accuracy;        ///< used by Precision::kTracked only
  std::uint32_t seed = 0;     ///< of the run: rotations
  double plane_max_tangent = 0.0;  ///< with receiver-plane bias: steeper planes are treated as this steep; 0: without
};

}  // namespace shadowbench::filters
