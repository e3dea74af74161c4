#pragma once

#include <glm/glm.hpp>

namespace shadowbench::scene {

/// The cone that a lamp in the scene lights.
struct Beam {
  glm::dvec3 position_ws{0.0};
  glm::dvec3 axis_ws{0.0, -1.0, 0.0};  ///< the way the light travels, unit length
  double cos_inner = 1.0;              ///< full strength within this angle of the axis
  double cos_outer = 0.0;              ///< none beyond this one
  double reference_m = 1.0;            ///< where its strength is 1

  /// The share of the cone's light that goes to a point, 0 .. 1: the square of a ramp between both angles, of cosines.
  /// Source: Khronos, KHR_lights_punctual, "Inner and Outer Cone Angles". 0 for the light's own place.
  double cone_at(const glm::dvec3& point_ws) const;
};

}  // namespace shadowbench::scene
