#include "filters/depth_curve.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace shadowbench::filters {

double depth_quantum(double depth, const DepthFormat& format) {
  if (!format.is_float) return 1.0 / (std::exp2(format.bits) - 1.0);
  // Depth below the smallest normal number is 0 on most GLs.
  const double size = std::max(std::abs(depth), double{std::numeric_limits<float>::min()});
  return std::exp2(std::floor(std::log2(size)) - 23.0);
}

double depth_step(double depth, const DepthCurve& curve, const DepthFormat& format) {
  const double ratio = curve.far_over_near, distance = 1.0 + (ratio - 1.0) * depth;  // in units of the near plane's
  return distance * distance / ratio * depth_quantum(curve.store(depth), format);
}

}  // namespace shadowbench::filters
