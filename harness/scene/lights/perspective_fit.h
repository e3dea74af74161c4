#pragma once

#include "harness/scene/lights/light_fit.h"

namespace shadowbench::scene {

/// Distances along a perspective map's axis of what stands in the map; nothing does where `farthest` is 0. Metres.
struct AxisExtent {
  double nearest = 0.0;
  double farthest = 0.0;

  /// Both in one.
  AxisExtent joined(const AxisExtent& other) const;
};

/// Finds what a square map sees that is drawn from a place in the scene: `light_from_world` looks along -z, and half
/// the map's side is `tangent` times the distance. A triangle that crosses the plane of the light begins at it.
AxisExtent find_extent(const Scene& scene, const glm::dmat4& light_from_world, double tangent);

/// The rigid transformation to a light's space, which looks along the beam's axis.
glm::dmat4 look_along(const Beam& beam);

/// The tangent of the map's half side that leaves `tangent` to the scene, and the rest to padding and snapping.
double pad_tangent(double tangent, const FitRequest& request);

/// The frustum of such a map, whose depth runs over `extent`.
LightFrustum fit_perspective(const Beam& beam, double tangent, const AxisExtent& extent, const FitRequest& request);

}  // namespace shadowbench::scene
