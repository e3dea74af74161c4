#pragma once

#include <array>
#include <cmath>
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

/// Where a camera stands, its axes, and how far it sees aside.
struct ViewAxes {
  explicit ViewAxes(const Camera& camera)
      : eye(camera.position_ws),
        forward(camera.forward_ws),
        right(glm::normalize(glm::cross(forward, glm::dvec3(camera.up_ws)))),
        up(glm::cross(right, forward)),
        half_height(0.5 * static_cast<double>(camera.orthographic_height_m)),
        tangent(std::tan(0.5 * static_cast<double>(camera.vertical_fov_rad))) {}

  glm::dvec3 eye, forward, right, up;
  double half_height;  ///< of an orthographic camera; else 0
  double tangent;      ///< of half the angle of view of another one
};

/// How far along its axis a camera sees a point, metres.
double view_depth(const Camera& camera, const glm::dvec3& point_ws);

/// The least and the greatest of these depths; without points the least is the largest number there is.
DepthSpan find_depth_span(const Camera& camera, const std::vector<glm::dvec3>& points);

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
