#pragma once

#include "filters/depth_map.h"

namespace shadowbench::filters {

/// The planes between which a perspective projection has depth; metres, 0 < near < far.
struct DepthPlanes {
  double near_m = 0.1;
  double far_m = 100.0;
};

/// The depth in [0,1] that a perspective projection stores for a distance along its axis: f / (f - n) (1 - n / d);
/// reversed: 1 minus that, n (f - d) / ((f - n) d). Source: OpenGL 4.5 core specification, section 13.6, with a
/// zero-to-one depth range.
inline double depth_of_distance(double distance_m, const DepthPlanes& planes, bool reversed) {
  return DepthCurve{reversed, planes.far_m / planes.near_m}.store((distance_m - planes.near_m) /
                                                                  (planes.far_m - planes.near_m));
}

/// The distance that a stored depth stands for; the inverse of depth_of_distance().
inline double distance_of_depth(double depth, const DepthPlanes& planes, bool reversed) {
  const double z = DepthCurve{reversed, planes.far_m / planes.near_m}.linear(depth);
  return planes.near_m + z * (planes.far_m - planes.near_m);
}

/// depth_step() in metres at a distance: d^2 (f - n) / (n f) times the quantum.
inline double distance_step(double distance_m, const DepthPlanes& planes, const DepthFormat& format, bool reversed) {
  const double range_m = planes.far_m - planes.near_m;
  return range_m * depth_step((distance_m - planes.near_m) / range_m, {reversed, planes.far_m / planes.near_m}, format);
}

}  // namespace shadowbench::filters
