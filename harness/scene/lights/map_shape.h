#pragma once

#include <glm/glm.hpp>
#include <string>

#include "reference/truth/visibility.h"

namespace shadowbench::scene {

struct LightFrustum;

/// How a point's place in the map follows from its place in the world; lib/map_shape.glsl does the same.
enum class MapShape {
  kPlane,        ///< a projection, that of the sun or of a lamp
  kWarped,       ///< a projection of the sun's map, with depth that stays linear
  kLogarithmic,  ///< the same, with v as the logarithm of w
  kParaboloid,   ///< half of all directions around a lamp
};

/// A map that is none of the light's own: the depths are written by the fragment shader.
inline bool is_curved(MapShape shape) { return shape != MapShape::kPlane; }

/// v = scale log(w) + offset.
struct LogCurve {
  double scale = 0.0;
  double offset = 0.0;

  bool operator==(const LogCurve&) const = default;
};

/// Where the directions of half a sphere lie in the map: in a circle.
struct Paraboloid {
  glm::dvec2 center{0.5};
  double radius = 0.5;

  bool operator==(const Paraboloid&) const = default;
};

/// Where a point lies in a curved map: u and v in [0,1], and depth.
glm::dvec3 find_in_curved_map(const LightFrustum& frustum, const glm::dvec3& point_ws);

/// How that changes.
truth::TexelGradients find_gradients(const LightFrustum& frustum, const glm::dvec3& point_ws);

/// All that the gradients depend on, as text.
std::string name_shape(const LightFrustum& frustum);

}  // namespace shadowbench::scene
