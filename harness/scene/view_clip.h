#pragma once

#include <array>
#include <glm/glm.hpp>
#include <optional>
#include <vector>

#include "harness/scene/scene.h"

namespace shadowbench::scene {

/// Depths along a camera's axis, metres.
struct DepthSpan {
  double near_m = 0.0;
  double far_m = 0.0;
};

/// How far along its axis a camera sees a point, metres.
double view_depth(const Camera& camera, const glm::dvec3& point_ws);

/// The corners of the scene's triangles after cutting them at the sides of what a camera sees, in world space; empty
/// where it sees nothing, or nothing between the two depths of `span`. Surfaces behind others are kept. `aspect` is
/// width / height of the picture.
///
/// A perspective camera sees nothing behind itself; an orthographic one is not cut along its direction.
/// Cost: one pass over the triangles, in double.
/// Source: Sutherland and Hodgman 1974, Reentrant Polygon Clipping, CACM 17(1).
std::vector<glm::dvec3> list_visible_corners(const Scene& scene, const Camera& camera, double aspect,
                                             const std::optional<DepthSpan>& span = std::nullopt);

/// The eight corners of what a camera sees between two depths.
using ViewCorners = std::array<glm::dvec3, 8>;
ViewCorners list_view_corners(const Camera& camera, double aspect, const DepthSpan& span);

}  // namespace shadowbench::scene
