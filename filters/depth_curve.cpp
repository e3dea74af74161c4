#include "filters/depth_curve.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace shadowbench::filters {

double depth_of_distance(double distance_m, const DepthPlanes& planes, bool reversed) {
  const double n = planes.near_m, f = planes.far_m;
  return (reversed ? n * (f - distance_m) : f * (distance_m - n)) / ((f - n) * distance_m);
}

double distance_of_depth(double depth, const DepthPlanes& planes, bool reversed) {
  const double n = planes.near_m, f = planes.far_m;
  return n * f / (reversed ? n + depth * (f - n) : f - depth * (f - n));
}

double depth_quantum(double depth, const DepthFormat& format) {
  if (!format.is_float) return 1.0 / (std::exp2(format.bits) - 1.0);
  // Depth below the smallest normal number is 0 on most GLs.
  const double size = std::max(std::abs(depth), double{std::numeric_limits<float>::min()});
  return std::exp2(std::floor(std::log2(size)) - 23.0);
}

double distance_step(double distance_m, const DepthPlanes& planes, const DepthFormat& format, bool reversed) {
  const double n = planes.near_m, f = planes.far_m;
  const double depth = depth_of_distance(distance_m, planes, reversed);
  return distance_m * distance_m * (f - n) / (n * f) * depth_quantum(depth, format);
}

}  // namespace shadowbench::filters
