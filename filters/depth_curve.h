#pragma once

namespace shadowbench::filters {

/// The planes between which a perspective projection has depth; metres, 0 < near < far.
struct DepthPlanes {
  double near_m = 0.1;
  double far_m = 100.0;
};

/// Gives the depth in [0,1] that a perspective projection stores for a distance along its axis:
/// f / (f - n) (1 - n / d); reversed: one less that, n (f - d) / ((f - n) d).
/// Source: OpenGL 4.5 core specification, section 13.6, with a zero-to-one depth range.
double depth_of_distance(double distance_m, const DepthPlanes& planes, bool reversed);

/// Gives the distance that a stored depth stands for; the inverse of depth_of_distance().
double distance_of_depth(double depth, const DepthPlanes& planes, bool reversed);

/// Says how a format stores depth.
struct DepthFormat {
  int bits = 32;
  bool is_float = true;
};

/// Gives the distance between neighbouring values of a format at a depth: 1 / (2^bits - 1), or the ULP of a float with 24
/// significant bits.
double depth_quantum(double depth, const DepthFormat& format);

/// Gives by how much two points at a distance must differ for a format to tell them apart:
/// d^2 (f - n) / (n f) times the format's quantum at the depth that is stored.
double distance_step(double distance_m, const DepthPlanes& planes, const DepthFormat& format, bool reversed);

}  // namespace shadowbench::filters
