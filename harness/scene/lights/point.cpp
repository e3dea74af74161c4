#include "harness/scene/lights/point.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "harness/scene/lights/light_fit.h"
#include "harness/scene/validate.h"

namespace shadowbench::scene {
namespace {

Beam make_face_beam(const PointLight& point, int face) {
  Beam beam = *find_beam(point);
  beam.axis_ws = glm::dvec3(0.0);
  beam.axis_ws[face / 2] = face % 2 == 0 ? 1.0 : -1.0;
  return beam;
}

AxisExtent find_extent_of_faces(const PointLight& point, const Scene& scene, double tangent) {
  AxisExtent extent;
  for (int face = 0; face < kCubeFaces; ++face)
    extent = extent.joined(find_extent(scene, look_along(make_face_beam(point, face)), tangent));
  return extent;
}

/// Depth is the distance: what is nearest along an axis is at least as far away, and no point is farther than a corner.
AxisExtent find_distances(const PointLight& point, const Scene& scene) {
  AxisExtent extent = find_extent_of_faces(point, scene, 1.0);
  for (const Mesh& mesh : scene.meshes)
    for (const Vertex& vertex : mesh.vertices)
      extent.farthest =
          std::max(extent.farthest, static_cast<double>(glm::distance(vertex.position_ws, point.position_ws)));
  return extent;
}

std::vector<LightFrustum> fit_paraboloids(const PointLight& point, const Scene& scene, const FitRequest& request) {
  const AxisExtent distances = find_distances(point, scene);
  std::vector<LightFrustum> halves;
  for (int half = 0; half < kHalfSpheres; ++half) {
    constexpr int kUp = 2, kDown = 3;
    LightFrustum fit = fit_perspective(make_face_beam(point, half == 0 ? kDown : kUp), 1.0, distances, request);
    fit.shape = MapShape::kParaboloid;
    fit.uv_depth_from_world = glm::mat4(fit.light_from_world);
    fit.paraboloid.radius = 0.5 * count_used_texels(request) / request.map_size;
    fit.paraboloid.center += request.shift_texels / static_cast<double>(request.map_size);
    fit.texel_size_ws = 2.0 * static_cast<double>(point.reference_m) / (fit.paraboloid.radius * request.map_size);
    fit.width_ws = fit.texel_size_ws * request.map_size;
    fit.layer = half;
    fit.share = HalfSphere{half == 1};
    halves.push_back(std::move(fit));
  }
  return halves;
}

}  // namespace

PointLight read_point(const TomlTable& table) {
  require_light_keys(table, {"position", "radius", "reference"});
  PointLight point;
  point.position_ws = glm::vec3(table.vec3("position", kAnyNumber));
  point.radius_m = table.number_f("radius", {0.0, 1000.0}, static_cast<double>(point.radius_m));
  point.reference_m = table.number_f("reference", kPositive, 1.0);
  return point;
}

PointLight checked_light(const PointLight& point, const std::string& where) {
  const glm::vec3& p = point.position_ws;
  if (std::isfinite(p.x + p.y + p.z) && std::isfinite(point.radius_m) && point.radius_m >= 0.0f &&
      std::isfinite(point.reference_m) && point.reference_m > 0.0f)
    return point;
  fail_input(fmt::format("the point light stands at ({}, {}, {}), with a radius of {} m and a reference of {} m: the "
                         "place must be finite, the radius 0 or more, the reference more than 0",
                         p.x, p.y, p.z, point.radius_m, point.reference_m),
             where);
}

std::optional<Beam> find_beam(const PointLight& point) {
  constexpr double kEveryCosine = -2.0;
  return Beam{glm::dvec3(point.position_ws),
              {0.0, -1.0, 0.0},
              kEveryCosine,
              kEveryCosine,
              static_cast<double>(point.reference_m)};
}

truth::AreaLight make_area_light(const PointLight& point) {
  return truth::AreaLight::make_sphere(glm::dvec3(point.position_ws), static_cast<double>(point.radius_m));
}

glm::vec3 to_light(const PointLight& point, const glm::vec3& point_ws) {
  return glm::normalize(point.position_ws - point_ws);
}

double light_size(const PointLight& point) { return 2.0 * static_cast<double>(point.radius_m); }

void turn_light(PointLight& point, const LightTurn& turn) {
  const float distance = glm::length(point.position_ws);
  if (distance > 0.0f) point.position_ws = -distance * turn(-point.position_ws / distance);
}

void aim_light(PointLight& point, const glm::vec3& center_ws) {
  const float distance = glm::distance(center_ws, point.position_ws);
  if (distance > 0.0f) point.reference_m = distance;
}

std::string describe_light(const PointLight& point) {
  return fmt::format("a point light, a sphere of {:.3g} m", 2.0f * point.radius_m);
}

std::vector<LightNumber> list_numbers(PointLight& point) {
  return {{"position", NumberRole::kPlace, {&point.position_ws.x, 3}},
          {"radius", NumberRole::kSize, {&point.radius_m, 1}, Range{0.0, 1.0}},
          {"reference", NumberRole::kReach, {&point.reference_m, 1}}};
}

int count_layers(const PointLight&, const MapWindow*, const FitRule& rule) {
  return rule.mode == FitMode::kParaboloid ? kHalfSpheres : kCubeFaces;
}

std::vector<LightFrustum> fit_layers(const PointLight& point, const MapWindow*, const Scene& scene,
                                     const FitRequest& request) {
  if (request.mode == FitMode::kParaboloid) return fit_paraboloids(point, scene, request);
  const double tangent = pad_tangent(1.0, request);
  const AxisExtent extent = find_extent_of_faces(point, scene, tangent);
  std::vector<LightFrustum> faces;
  for (int face = 0; face < kCubeFaces; ++face) {
    faces.push_back(fit_perspective(make_face_beam(point, face), tangent, extent, request));
    faces.back().layer = face;
    faces.back().share = CubeFace{face};
  }
  return faces;
}

}  // namespace shadowbench::scene
