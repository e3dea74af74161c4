#include "harness/scene/view_clip.h"

#include <cmath>

namespace shadowbench::scene {
namespace {

/// A plane; points with dot(normal, p) + offset >= 0 are inside.
struct HalfSpace {
  glm::dvec3 normal;
  double offset;
  double distance(const glm::dvec3& p) const { return glm::dot(normal, p) + offset; }
};

std::vector<HalfSpace> bound_view(const Camera& camera, double aspect) {
  const glm::dvec3 eye(camera.position_ws), forward(camera.forward_ws);
  const glm::dvec3 right = glm::normalize(glm::cross(forward, glm::dvec3(camera.up_ws)));
  const glm::dvec3 up = glm::cross(right, forward);
  const double half_height = 0.5 * static_cast<double>(camera.orthographic_height_m);
  const double tangent = std::tan(0.5 * static_cast<double>(camera.vertical_fov_rad));
  std::vector<HalfSpace> bounds;
  const auto add = [&](const glm::dvec3& normal, double offset) {
    bounds.push_back({normal, offset - glm::dot(normal, eye)});
  };
  for (const double side : {-1.0, 1.0}) {
    add(side * right + (half_height > 0.0 ? 0.0 : tangent * aspect) * forward, half_height * aspect);
    add(side * up + (half_height > 0.0 ? 0.0 : tangent) * forward, half_height);
  }
  if (!(half_height > 0.0)) add(forward, 0.0);
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

std::vector<glm::dvec3> list_visible_corners(const Scene& scene, const Camera& camera, double aspect) {
  const std::vector<HalfSpace> bounds = bound_view(camera, aspect);
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
