#include "harness/scene/light_fit.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "filters/error.h"

namespace shadowbench::scene {
namespace {

/// A box in the light's space.
struct Box {
  glm::dvec3 min{std::numeric_limits<double>::max()};
  glm::dvec3 max{std::numeric_limits<double>::lowest()};
};

glm::dvec3 axis_least_parallel(const glm::dvec3& direction) {
  const glm::dvec3 size = glm::abs(direction);
  if (size.z <= size.x && size.z <= size.y) return {0.0, 0.0, 1.0};
  return size.x <= size.y ? glm::dvec3(1.0, 0.0, 0.0) : glm::dvec3(0.0, 1.0, 0.0);
}

/// World axes seen by the light, which looks along -z; rows are the light's x, y and z.
glm::dmat3 light_rotation(const glm::dvec3& direction) {
  const glm::dvec3 back = -direction;
  const glm::dvec3 right = glm::normalize(glm::cross(axis_least_parallel(direction), back));
  return glm::transpose(glm::dmat3(right, glm::cross(back, right), back));
}

glm::dvec3 center_of(const Bounds& bounds) { return 0.5 * (glm::dvec3(bounds.min) + glm::dvec3(bounds.max)); }

template <typename Visit>
void for_each_position(const Scene& scene, const Visit& visit) {
  for (const Mesh& mesh : scene.meshes) {
    for (const Vertex& vertex : mesh.vertices) visit(glm::dvec3(vertex.position_ws));
  }
}

/// The scene's extent around `center`, along the light's axes.
Box tight_box(const Scene& scene, const glm::dmat3& rotation, const glm::dvec3& center) {
  Box box;
  for_each_position(scene, [&](const glm::dvec3& p) {
    const glm::dvec3 seen = rotation * (p - center);
    box.min = glm::min(box.min, seen);
    box.max = glm::max(box.max, seen);
  });
  return box;
}

Box sphere_box(const Scene& scene, const glm::dvec3& center) {
  double radius = 0.0;
  for_each_position(scene, [&](const glm::dvec3& p) { radius = std::max(radius, glm::length(p - center)); });
  return {glm::dvec3(-radius), glm::dvec3(radius)};
}

/// Depth is computed in float, from coordinates as large as `largest_coordinate`.
double depth_padding(double range, double side, double largest_coordinate) {
  constexpr double kRelative = 1e-4;
  constexpr double kRoundings = 8.0 * double{std::numeric_limits<float>::epsilon()};
  const double flat = range < 1e-3 * side ? 5e-4 * side : 0.0;
  return std::max({kRelative * range, flat, kRoundings * largest_coordinate});
}

glm::dmat4 scale_then_move(const glm::dvec3& scale, const glm::dvec3& offset) {
  glm::dmat4 m(1.0);
  for (int i = 0; i < 3; ++i) m[i][i] = scale[i];
  m[3] = glm::dvec4(offset, 1.0);
  return m;
}

}  // namespace

LightFrustum fit_light(const Scene& scene, FitMode mode, int map_size, double pad_texels) {
  const double used_texels = map_size - 2.0 * pad_texels;
  if (!(used_texels >= 1.0)) {
    throw Error(ErrorKind::kUsage,
                fmt::format("a map of {} texels has no room for a kernel of {} texels on every side; "
                            "use a larger map or a smaller radius",
                            map_size, pad_texels));
  }
  const Bounds bounds = scene.bounds();
  const glm::dvec3 center = center_of(bounds);
  const glm::dvec3 direction = glm::normalize(glm::dvec3(scene.light.direction_ws));
  const glm::dmat3 rotation = light_rotation(direction);
  const Box box = mode == FitMode::kTight ? tight_box(scene, rotation, center) : sphere_box(scene, center);

  const glm::dvec3 extent = box.max - box.min;
  const double side = std::max({extent.x, extent.y, 1e-3 * extent.z});
  const glm::dvec3 farthest = glm::max(glm::abs(glm::dvec3(bounds.min)), glm::abs(glm::dvec3(bounds.max)));
  const double largest = std::max({farthest.x, farthest.y, farthest.z});
  const double padding = depth_padding(extent.z, side, largest);

  LightFrustum fit;
  fit.texel_size_ws = side / used_texels;
  fit.width_ws = fit.texel_size_ws * map_size;
  fit.depth_range_ws = extent.z + 2.0 * padding;
  fit.direction_ws = glm::vec3(direction);
  const glm::dvec3 eye(0.5 * (box.min.x + box.max.x), 0.5 * (box.min.y + box.max.y), box.max.z + padding);
  fit.light_from_world = glm::dmat4(rotation);
  fit.light_from_world[3] = glm::dvec4(-(rotation * center) - eye, 1.0);
  const double half = 2.0 / fit.width_ws;
  const glm::dmat4 clip_from_light = scale_then_move({half, half, -1.0 / fit.depth_range_ws}, glm::dvec3(0.0));
  const glm::dmat4 uv_from_clip = scale_then_move({0.5, 0.5, 1.0}, {0.5, 0.5, 0.0});
  fit.clip_from_world = glm::mat4(clip_from_light * fit.light_from_world);
  fit.uv_depth_from_world = glm::mat4(uv_from_clip * clip_from_light * fit.light_from_world);
  return fit;
}

}  // namespace shadowbench::scene
