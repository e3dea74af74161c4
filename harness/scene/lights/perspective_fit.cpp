#include "harness/scene/lights/perspective_fit.h"

#include <algorithm>
#include <limits>

namespace shadowbench::scene {
namespace {

/// Depth is computed in float, and a near plane at the lamp would leave none of it for the scene.
PerspectiveMap make_planes(const Beam& beam, const AxisExtent& extent) {
  constexpr double kPadding = 1e-3, kLeastNear = 1.0 / 500.0;
  if (extent.farthest <= 0.0) return {beam, 0.5 * beam.reference_m, 2.0 * beam.reference_m};
  const double far_m = extent.farthest * (1.0 + kPadding);
  return {beam, std::max(extent.nearest * (1.0 - kPadding), kLeastNear * far_m), far_m};
}

}  // namespace

AxisExtent AxisExtent::joined(const AxisExtent& other) const {
  if (farthest <= 0.0) return other;
  if (other.farthest <= 0.0) return *this;
  return {std::min(nearest, other.nearest), std::max(farthest, other.farthest)};
}

AxisExtent find_extent(const Scene& scene, const glm::dmat4& light_from_world, double tangent) {
  AxisExtent extent;
  const auto see = [&](const glm::vec3& p) { return glm::dvec3(light_from_world * glm::dvec4(p, 1.0)); };
  for (const Mesh& mesh : scene.meshes) {
    for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
      glm::dvec3 least(std::numeric_limits<double>::max()), most(std::numeric_limits<double>::lowest());
      for (std::size_t k = 0; k < 3; ++k) {
        const glm::dvec3 seen = see(mesh.vertices[mesh.indices[i + k]].position_ws);
        least = glm::min(least, seen);
        most = glm::max(most, seen);
      }
      const double reach = -least.z * tangent;  // half of the square where it is widest over this triangle
      if (-least.z <= 0.0 || least.x > reach || most.x < -reach || least.y > reach || most.y < -reach) continue;
      extent = extent.joined({std::max(-most.z, 0.0), -least.z});
    }
  }
  return extent;
}

glm::dmat4 look_along(const Beam& beam) {
  const glm::dmat3 rotation = light_rotation(beam.axis_ws);
  glm::dmat4 light_from_world(rotation);
  light_from_world[3] = glm::dvec4(-(rotation * beam.position_ws), 1.0);
  return light_from_world;
}

double pad_tangent(double tangent, const FitRequest& request) {
  return tangent * request.map_size / count_used_texels(request);
}

LightFrustum fit_perspective(const Beam& beam, double tangent, const AxisExtent& extent, const FitRequest& request) {
  LightFrustum fit;
  fit.light_from_world = look_along(beam);
  fit.perspective = make_planes(beam, extent);
  fit.projective = true;
  fit.direction_ws = glm::vec3(beam.axis_ws);
  fit.width_ws = 2.0 * tangent * beam.reference_m;
  fit.texel_size_ws = fit.width_ws / request.map_size;
  fit.depth_range_ws = fit.perspective->far_m - fit.perspective->near_m;
  set_perspective(fit, tangent, 2.0 * request.shift_texels / static_cast<double>(request.map_size));
  return fit;
}

}  // namespace shadowbench::scene
