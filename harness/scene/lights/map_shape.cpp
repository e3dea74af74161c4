#include "harness/scene/lights/map_shape.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <span>

#include "harness/scene/lights/light_fit.h"

namespace shadowbench::scene {
namespace {

/// A direction as a paraboloid sees it: along the light's right and up, and along its axis.
struct Ray {
  double distance_m;
  glm::dvec3 direction_ws, right_ws, up_ws, axis_ws;
  double x, y, along;
};

Ray find_ray(const LightFrustum& frustum, const glm::dvec3& point_ws) {
  const glm::dmat4 rows = glm::transpose(frustum.light_from_world);
  Ray ray{glm::distance(point_ws, frustum.perspective->beam.position_ws),
          glm::normalize(point_ws - frustum.perspective->beam.position_ws),
          glm::dvec3(rows[0]),
          glm::dvec3(rows[1]),
          frustum.perspective->beam.axis_ws,
          0.0,
          0.0,
          0.0};
  ray.x = glm::dot(ray.direction_ws, ray.right_ws);
  ray.y = glm::dot(ray.direction_ws, ray.up_ws);
  ray.along = glm::dot(ray.direction_ws, ray.axis_ws);
  return ray;
}

truth::TexelGradients find_paraboloid_gradients(const LightFrustum& frustum, const glm::dvec3& point_ws) {
  const Ray ray = find_ray(frustum, point_ws);
  const glm::dvec3 towards_axis = (ray.axis_ws - ray.along * ray.direction_ws) / (1.0 + ray.along);
  const double scale = frustum.map_texels() * frustum.paraboloid.radius / ((1.0 + ray.along) * ray.distance_m);
  return {scale * (ray.right_ws - ray.x * ray.direction_ws - ray.x * towards_axis),
          scale * (ray.up_ws - ray.y * ray.direction_ws - ray.y * towards_axis)};
}

/// A step along the light's axis changes nothing under the sun; under a lamp it moves a place towards the map's middle.
truth::TexelGradients find_plane_gradients(const LightFrustum& frustum, const glm::dvec3& point_ws) {
  const glm::dmat4 rows = glm::transpose(frustum.light_from_world);
  const double texel = frustum.texel_size_at(point_ws);
  truth::TexelGradients along{glm::dvec3(rows[0]) / texel, glm::dvec3(rows[1]) / texel};
  if (!frustum.perspective) return along;
  const Beam& beam = frustum.perspective->beam;
  const glm::dvec3 way = point_ws - beam.position_ws,
                   per_metre = beam.axis_ws / frustum.perspective->distance(point_ws);
  along.u -= glm::dot(along.u, way) * per_metre;
  along.v -= glm::dot(along.v, way) * per_metre;
  return along;
}

}  // namespace

glm::dvec3 find_in_curved_map(const LightFrustum& frustum, const glm::dvec3& point_ws) {
  if (frustum.shape == MapShape::kParaboloid) {
    const Ray ray = find_ray(frustum, point_ws);
    const double scale = frustum.paraboloid.radius / (1.0 + ray.along);
    const glm::dvec2& center = frustum.paraboloid.center;
    return {center.x + scale * ray.x, center.y + scale * ray.y,
            (ray.distance_m - frustum.perspective->near_m) / frustum.depth_range_ws};
  }
  const glm::dvec4 seen = frustum.light_from_world * glm::dvec4(point_ws, 1.0), clip = frustum.clip_from_light * seen;
  const double v = frustum.shape == MapShape::kLogarithmic
                       ? frustum.log_curve.scale * std::log(clip.w) + frustum.log_curve.offset
                       : 0.5 + 0.5 * clip.y / clip.w;
  return {0.5 + 0.5 * clip.x / clip.w, v, -seen.z / frustum.depth_range_ws};
}

truth::TexelGradients find_gradients(const LightFrustum& frustum, const glm::dvec3& point_ws) {
  if (frustum.shape == MapShape::kParaboloid) return find_paraboloid_gradients(frustum, point_ws);
  if (frustum.shape == MapShape::kPlane) return find_plane_gradients(frustum, point_ws);
  const glm::dmat4 clip_from_world = frustum.clip_from_light * frustum.light_from_world;
  const glm::dmat4 rows = glm::transpose(clip_from_world);
  const glm::dvec4 clip = clip_from_world * glm::dvec4(point_ws, 1.0);
  const auto along = [&](int row) {
    return (0.5 * frustum.map_texels() / clip.w) * glm::dvec3(rows[row] - (clip[row] / clip.w) * rows[3]);
  };
  if (frustum.shape != MapShape::kLogarithmic) return {along(0), along(1)};
  return {along(0), (frustum.map_texels() * frustum.log_curve.scale / clip.w) * glm::dvec3(rows[3])};
}

std::string name_shape(const LightFrustum& frustum) {
  const glm::dmat4 clip_from_world = frustum.clip_from_light * frustum.light_from_world;
  return fmt::format("shape {} {} {} {} {} {}", static_cast<int>(frustum.shape), frustum.map_texels(),
                     frustum.paraboloid.radius, frustum.log_curve.scale, frustum.layer,
                     fmt::join(std::span(&clip_from_world[0][0], 16), " "));
}

}  // namespace shadowbench::scene
