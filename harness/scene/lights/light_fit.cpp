#include "harness/scene/lights/light_fit.h"

#include <fmt/format.h>

#include <cassert>
#include <cmath>

#include "filters/base/error.h"
#include "harness/scene/mesh_tools.h"

namespace shadowbench::scene {

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

namespace {

const MapWindow* find_window(const Light& light) { return light.map_window ? &*light.map_window : nullptr; }

}  // namespace

std::vector<LightFrustum> fit_layers(const Scene& scene, const FitRequest& request) {
  const Light& light = request.light ? *request.light : scene.light;
  return std::visit([&](const auto& kind) { return fit_layers(kind, find_window(light), scene, request); }, light.kind);
}

int count_layers(const Light& light, const FitRule& rule) {
  return std::visit([&](const auto& kind) { return count_layers(kind, find_window(light), rule); }, light.kind);
}

}  // namespace shadowbench::scene
