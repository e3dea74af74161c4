#include "harness/scene/view_clip.h"

#include <algorithm>
#include <limits>

namespace shadowbench::scene {
namespace {

/// A plane; points with dot(normal, p) + offset >= 0 are inside.
struct HalfSpace {
  glm::dvec3 normal;
  double offset;
  double distance(const glm::dvec3& p) const { return glm::dot(normal, p) + offset; }
};

std::vector<HalfSpace> bound_view(const Camera& camera, double aspect, const std::optional<DepthSpan>& span) {
  const auto [eye, forward, right, up, half_height, tangent] = ViewAxes(camera);
  std::vector<HalfSpace> bounds;
  const auto add = [&bounds, &eye = eye](const glm::dvec3& normal, double offset) {
    bounds.push_back({normal, offset - glm::dot(normal, eye)});
  };
  for (const double side : {-1.0, 1.0}) {
    add(side * right + (half_height > 0.0 ? 0.0 : tangent * aspect) * forward, half_height * aspect);
    add(side * up + (half_height > 0.0 ? 0.0 : tangent) * forward, half_height);
  }
  if (!(half_height > 0.0)) add(forward, 0.0);
  if (span) {
    add(forward, -span->near_m);
    add(-forward, span->far_m);
  }
  return bounds;
}

using Polygon = std::vector<glm::dvec3>;

Polygon cut(const Polygon& polygon, const HalfSpace& bound) {
  Polygon kept;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const glm::dvec3 &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
    const double da = bound.distance(a), db = bound.distance(b);
    if (da >= 0.0) kept.push_back(a);
    if ((da >= 0.0) != (db >= 0.0)) kept.push_back(a + (b - a) * (da / (da - db)));
  }
  return kept;
}

}  // namespace

double view_depth(const Camera& camera, const glm::dvec3& point_ws) {
  return glm::dot(point_ws - glm::dvec3(camera.position_ws), glm::dvec3(camera.forward_ws));
}

DepthSpan find_depth_span(const Camera& camera, const std::vector<glm::dvec3>& points) {
  DepthSpan span{std::numeric_limits<double>::max(), 0.0};
  for (const glm::dvec3& p : points) {
    const double depth = view_depth(camera, p);
    span = {std::min(span.near_m, depth), std::max(span.far_m, depth)};
  }
  return span;
}

ViewCorners list_view_corners(const Camera& camera, double aspect, const DepthSpan& span) {
  const ViewAxes axes(camera);
  ViewCorners corners;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const double depth = i < 4 ? span.near_m : span.far_m;
    const double half = axes.half_height > 0.0 ? axes.half_height : axes.tangent * depth;
    corners[i] = axes.eye + depth * axes.forward + (i % 2 ? half : -half) * aspect * axes.right +
                 (i / 2 % 2 ? half : -half) * axes.up;
  }
  return corners;
}

std::vector<glm::dvec3> list_visible_corners(const Scene& scene, const Camera& camera, double aspect,
                                             const std::optional<DepthSpan>& span) {
  const std::vector<HalfSpace> bounds = bound_view(camera, aspect, span);
  std::vector<glm::dvec3> corners;
  for (const Mesh& mesh : scene.meshes) {
    for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
      Polygon polygon;
      for (std::size_t k = 0; k < 3; ++k) polygon.emplace_back(mesh.vertices[mesh.indices[i + k]].position_ws);
      for (const HalfSpace& bound : bounds)
        if (!polygon.empty()) polygon = cut(polygon, bound);
      corners.insert(corners.end(), polygon.begin(), polygon.end());
    }
  }
  return corners;
}

}  // namespace shadowbench::scene
