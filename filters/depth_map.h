#pragma once

#include <algorithm>
#include <vector>

#include "filters/map_range.h"

namespace shadowbench::filters {

/// A depth map as read back from the GL; row 0 is v = 0, depth in [0,1].
struct DepthMap {
  int size = 0;                      ///< texels per side
  std::vector<float> depth;          ///< size * size
  /// Fixed-point formats clamp the reference of a comparison to [0,1], float formats do not (OpenGL 4.5, section 8.23).
  bool clamps_reference = false;
  /// Comparisons of values this near are decided by rounding, in addition to one ULP of the reference.
  float tie = 0.0f;
  Border border = Border::kBorder;   ///< what lookups read outside

  /// Gives the depth that a comparison with `z` uses.
  float reference(float z) const { return clamps_reference ? std::clamp(z, 0.0f, 1.0f) : z; }
};

}  // namespace shadowbench::filters
