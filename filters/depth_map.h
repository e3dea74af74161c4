#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include "filters/depth_curve.h"
#include "filters/map_range.h"

namespace shadowbench::filters {

/// A depth map as read back from the GL; row 0 is v = 0.
struct DepthMap {
  int size = 0;               ///< texels per side
  std::vector<float> stored;  ///< size * size, in [0,1]; what it means is the curve's
  DepthCurve curve{};
  /// Fixed-point formats clamp the reference of a comparison to [0,1], float formats do not (OpenGL 4.5, section 8.23).
  bool clamps_reference = false;
  Border border = Border::kBorder;  ///< what lookups read outside
  int texel_bytes = 4;              ///< of the map in the GL

  /// What a comparison with depth `z` compares with.
  float reference(float z) const {
    const float reference = curve.store(z);
    return clamps_reference ? std::clamp(reference, 0.0f, 1.0f) : reference;
  }

  /// What a lookup finds in a texel, or outside the map where there is none.
  float at(const std::optional<std::size_t>& texel) const { return texel ? stored[*texel] : curve.far_plane(); }

  /// Whether depth `z` is lit by a stored depth; ties are.
  bool is_lit(float z, float by) const { return curve.is_lit(reference(z), by); }

  /// Whether rounding may decide that comparison: `z` may be off by one ULP, and by some more if the curve divides.
  bool is_tie(float z, float by) const {
    const float ulp = std::nextafter(std::abs(z), 2.0f * std::abs(z) + 1.0f) - std::abs(z);
    const auto [least, most] = std::minmax({reference(z - ulp), reference(z + ulp)});
    const float rounding = curve.is_linear() ? 0.0f : kCurveRounding * std::abs(by);
    return least - rounding <= by && by <= most + rounding;
  }

 private:
  static constexpr float kCurveRounding = 4.0f * std::numeric_limits<float>::epsilon();
};

}  // namespace shadowbench::filters
