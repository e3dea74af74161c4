#include "harness/scene/lights/light_fit.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <glm/gtx/component_wise.hpp>
#include <limits>
#include <span>

#include "base/error.h"
#include "harness/scene/mesh_tools.h"

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

/// Where a point lies in a curved map: u and v in [0,1], and depth.
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

/// All that the gradients depend on, as text.
std::string name_shape(const LightFrustum& frustum) {
  const glm::dmat4 clip_from_world = frustum.clip_from_light * frustum.light_from_world;
  return fmt::format("shape {} {} {} {} {} {}", static_cast<int>(frustum.shape), frustum.map_texels(),
                     frustum.paraboloid.radius, frustum.log_curve.scale, frustum.layer,
                     fmt::join(std::span(&clip_from_world[0][0], 16), " "));
}

const MapWindow* find_window(const Light& light) { return light.map_window ? &*light.map_window : nullptr; }

/// Depth is computed in float, and a near plane at the lamp would leave none of it for the scene.
PerspectiveMap make_planes(const Beam& beam, const AxisExtent& extent) {
  constexpr double kPadding = 1e-3, kLeastNear = 1.0 / 500.0;
  if (extent.farthest <= 0.0) return {beam, 0.5 * beam.reference_m, 2.0 * beam.reference_m};
  const double far_m = extent.farthest * (1.0 + kPadding);
  return {beam, std::max(extent.nearest * (1.0 - kPadding), kLeastNear * far_m), far_m};
}

/// Whether two layers serve the same receivers, but for rounding: a camera's place is in single precision.
bool is_alike(const LayerShare& a, const LayerShare& b) {
  const auto *one = std::get_if<ViewSlice>(&a), *other = std::get_if<ViewSlice>(&b);
  if (!one || !other) return a == b;
  const auto is_near = [](double x, double y) { return std::abs(x - y) <= 1e-4 * std::abs(x); };
  return is_near(one->fade_in_begin, other->fade_in_begin) && is_near(one->fade_in_end, other->fade_in_end) &&
         is_near(one->fade_out_begin, other->fade_out_begin) && is_near(one->fade_out_end, other->fade_out_end);
}

}  // namespace

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

glm::dvec3 LightFrustum::to_light(const glm::dvec3& point_ws) const {
  return perspective ? glm::normalize(perspective->beam.position_ws - point_ws) : -glm::dvec3(direction_ws);
}

double LightFrustum::texel_size_at(const glm::dvec3& point_ws) const {
  if (is_curved(shape)) {
    const truth::TexelGradients along = find_gradients(*this, point_ws);
    return 1.0 / std::sqrt(glm::length(glm::cross(along.u, along.v)));
  }
  return perspective ? texel_size_ws * perspective->distance(point_ws) / perspective->beam.reference_m : texel_size_ws;
}

glm::dvec3 LightFrustum::place(const glm::dvec3& point_ws, int map_size) const {
  if (is_curved(shape)) return find_in_curved_map(*this, point_ws) * glm::dvec3(map_size, map_size, 1.0);
  const glm::dvec4 seen = light_from_world * glm::dvec4(point_ws, 1.0);
  if (!perspective)
    return {seen.x / texel_size_ws + 0.5 * map_size, seen.y / texel_size_ws + 0.5 * map_size, -seen.z / depth_range_ws};
  const glm::dvec4 clip = clip_from_light * seen;
  return {(0.5 + 0.5 * clip.x / clip.w) * map_size, (0.5 + 0.5 * clip.y / clip.w) * map_size,
          (-seen.z - perspective->near_m) / depth_range_ws};
}

glm::dmat3 light_rotation(const glm::dvec3& direction) {
  const glm::dvec3 back = -direction;
  const glm::dvec3 right = glm::normalize(glm::cross(axis_least_parallel(direction), back));
  return glm::transpose(glm::dmat3(right, glm::cross(back, right), back));
}

double count_used_texels(const FitRequest& request) {
  const double used = request.map_size - 2.0 * request.pad_texels - (request.snap ? 1.0 : 0.0);
  if (used >= 1.0) return used;
  throw Error(ErrorKind::kUsage,
              fmt::format("a map of {} texels has no room for a kernel of {} texels on every side{}; "
                          "use a larger map or a smaller radius",
                          request.map_size, request.pad_texels, request.snap ? " and a texel to snap" : ""));
}

void set_perspective(LightFrustum& frustum, double tangent, const glm::dvec2& shift_clip) {
  const double near_m = frustum.perspective->near_m, far_m = frustum.perspective->far_m, range = far_m - near_m;
  glm::dmat4& clip = frustum.clip_from_light = glm::dmat4(0.0);
  clip[0][0] = clip[1][1] = 1.0 / tangent;
  clip[2] = glm::dvec4(shift_clip, -far_m / range, -1.0);  // w is the distance along the axis
  clip[3][2] = -far_m * near_m / range;
  frustum.clip_from_world = glm::mat4(clip * frustum.light_from_world);
  glm::dmat4 uv_depth = clip;
  for (int column = 0; column < 4; ++column)
    for (int row = 0; row < 2; ++row) uv_depth[column][row] = 0.5 * (clip[column][row] + clip[column][3]);
  for (int column = 0; column < 4; ++column) uv_depth[column][2] = 0.0;
  uv_depth[2][2] = -1.0 / range;
  uv_depth[3][2] = -near_m / range;
  frustum.uv_depth_from_world = glm::mat4(uv_depth * frustum.light_from_world);
}

truth::MapGrid make_map_grid(const LightFrustum& frustum) {
  const glm::dmat4 rows = glm::transpose(frustum.light_from_world);
  truth::MapGrid grid{
      -glm::dvec3(frustum.direction_ws), glm::dvec3(rows[0]), glm::dvec3(rows[1]), frustum.texel_size_ws, {}, {}};
  if (frustum.perspective)
    grid.lamp = truth::MapGrid::Lamp{frustum.perspective->beam.position_ws, frustum.perspective->beam.reference_m};
  if (is_curved(frustum.shape)) {
    grid.curved = truth::MapGrid::Curved{[frustum](const glm::dvec3& p) { return find_gradients(frustum, p); },
                                         name_shape(frustum)};
  }
  return grid;
}

LightFrustum fit_light(const Scene& scene, FitMode mode, int map_size, double pad_texels) {
  return fit_light(scene, FitRequest{.mode = mode, .map_size = map_size, .pad_texels = pad_texels});
}

LightFrustum fit_light(const Scene& scene, const FitRequest& request) {
  std::vector<LightFrustum> layers = fit_layers(scene, request);
  assert(layers.size() == 1);
  return std::move(layers.front());
}

std::vector<LightFrustum> fit_layers(const Scene& scene, const FitRequest& request) {
  const Light& light = request.light ? *request.light : scene.light;
  return std::visit([&](const auto& kind) { return fit_layers(kind, find_window(light), scene, request); }, light.kind);
}

bool follows_camera(const Light& light, const FitRule& rule) {
  return rule.follows_view() && !light.map_window && !find_beam(light);
}

bool has_same_grid(const LightFrustum& a, const LightFrustum& b) {
  constexpr double kRounding = 1e-6;  // of a texel
  if (is_curved(a.shape) || is_curved(b.shape) || !is_alike(a.share, b.share)) return false;
  if (std::abs(a.texel_size_ws - b.texel_size_ws) > kRounding * a.texel_size_ws) return false;
  const glm::dvec2 moved = glm::dvec2(a.light_from_world[3] - b.light_from_world[3]) / a.texel_size_ws;
  return glm::compMax(glm::abs(moved - glm::round(moved))) < kRounding;
}

int count_layers(const Light& light, const FitRule& rule) {
  return std::visit([&](const auto& kind) { return count_layers(kind, find_window(light), rule); }, light.kind);
}

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
