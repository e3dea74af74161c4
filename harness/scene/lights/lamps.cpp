#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "harness/scene/files/mesh_file.h"
#include "harness/scene/lights/light_fit.h"
#include "harness/scene/lights/light_kinds.h"
#include "harness/scene/mesh_tools.h"
#include "harness/scene/scene.h"

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

namespace {

constexpr double kLeastCone_deg = 0.1;

bool is_rectangle(const Spot& spot) { return spot.size_m.x > 0.0f && spot.size_m.y > 0.0f; }

}  // namespace

double Beam::cone_at(const glm::dvec3& point_ws) const {
  const glm::dvec3 way = point_ws - position_ws;
  const double cosine = glm::dot(way, axis_ws) / std::max(glm::length(way), std::numeric_limits<double>::min());
  const double ramp = std::clamp((cosine - cos_outer) / std::max(cos_inner - cos_outer, 1e-4), 0.0, 1.0);
  return ramp * ramp;
}

Spot read_spot(const TomlTable& table) {
  require_light_keys(table, {"position", "target", "cone_deg", "inner_cone_deg", "radius", "size"});
  Spot spot;
  spot.position_ws = glm::vec3(table.vec3("position", kAnyNumber));
  spot.target_ws = glm::vec3(table.vec3("target", kAnyNumber));
  const double cone_deg = table.number("cone_deg", {kLeastCone_deg, double{kWidestCone_deg}}, 60.0);
  spot.cone_deg = static_cast<float>(cone_deg);
  spot.inner_cone_deg = table.number_f("inner_cone_deg", {0.0, cone_deg}, 0.75 * cone_deg);
  spot.radius_m = table.number_f("radius", {0.0, 1000.0}, static_cast<double>(spot.radius_m));
  if (table.has("size")) {
    if (table.has("radius")) throw table.error("size", "[light] has both a 'radius' and a 'size': give one");
    spot.size_m = glm::vec2(table.vec2("size", kPositive));
    spot.radius_m = 0.0f;
  }
  if (spot.position_ws == spot.target_ws)
    throw table.error("target", "'target' in [light] is where the light stands: it has no direction");
  return spot;
}

std::optional<Beam> find_beam(const Spot& spot) {
  const glm::dvec3 way = glm::dvec3(spot.target_ws) - glm::dvec3(spot.position_ws);
  const auto half_cosine = [](float degrees) { return std::cos(0.5 * glm::radians(static_cast<double>(degrees))); };
  return Beam{glm::dvec3(spot.position_ws), glm::normalize(way), half_cosine(spot.inner_cone_deg),
              half_cosine(spot.cone_deg), glm::length(way)};
}

double light_size(const Spot& spot) {
  if (!is_rectangle(spot)) return 2.0 * static_cast<double>(spot.radius_m);
  return 2.0 * std::sqrt(static_cast<double>(spot.size_m.x) * static_cast<double>(spot.size_m.y) / std::numbers::pi);
}

truth::AreaLight make_area_light(const Spot& spot) {
  const Beam beam = *find_beam(spot);
  if (is_rectangle(spot)) {
    const glm::dmat3 axes = glm::transpose(light_rotation(beam.axis_ws));
    return truth::AreaLight::make_rectangle(beam.position_ws, 0.5 * static_cast<double>(spot.size_m.x) * axes[0],
                                            0.5 * static_cast<double>(spot.size_m.y) * axes[1]);
  }
  return truth::AreaLight::make_disk(beam.position_ws, beam.axis_ws, static_cast<double>(spot.radius_m));
}

glm::vec3 to_light(const Spot& spot, const glm::vec3& point_ws) { return glm::normalize(spot.position_ws - point_ws); }

void turn_light(Spot& spot, const LightTurn& turn) {
  const glm::vec3 way = spot.target_ws - spot.position_ws;
  spot.position_ws = spot.target_ws - glm::length(way) * turn(glm::normalize(way));
}

void aim_light(Spot& spot, const glm::vec3& center_ws) {
  const glm::vec3 ahead = spot.target_ws - spot.position_ws;
  const float distance = glm::dot(center_ws - spot.position_ws, ahead);
  if (distance > 0.0f) spot.target_ws = spot.position_ws + distance * ahead;
}

Spot checked_light(const Spot& spot, const std::string& where) {
  unit_direction(spot.target_ws - spot.position_ws, "the light", where);
  const double cone = static_cast<double>(spot.cone_deg);
  if (cone >= kLeastCone_deg && cone <= double{kWidestCone_deg} && spot.inner_cone_deg >= 0.0f &&
      spot.inner_cone_deg <= spot.cone_deg && spot.radius_m >= 0.0f && std::isfinite(spot.radius_m) &&
      glm::all(glm::greaterThanEqual(spot.size_m, glm::vec2(0.0f))) && std::isfinite(spot.size_m.x + spot.size_m.y))
    return spot;
  fail_input(fmt::format("the spot light has a cone of {} degrees, {} within, and a radius of {} m: the cone must lie "
                         "within {} .. {}, and the inner one within it",
                         spot.cone_deg, spot.inner_cone_deg, spot.radius_m, kLeastCone_deg, kWidestCone_deg),
             where);
}

std::string describe_light(const Spot& spot) {
  const std::string size = is_rectangle(spot) ? fmt::format("{:.3g} x {:.3g}", spot.size_m.x, spot.size_m.y)
                                              : fmt::format("{:.3g}", 2.0f * spot.radius_m);
  return fmt::format("a spot light of {} m, {:.3g} m from its target", size,
                     glm::distance(spot.position_ws, spot.target_ws));
}

std::vector<LightNumber> list_numbers(Spot& spot) {
  const bool flat = is_rectangle(spot);
  return {{"position", NumberRole::kPlace, {&spot.position_ws.x, 3}},
          {"target", NumberRole::kPlace, {&spot.target_ws.x, 3}},
          {"radius", NumberRole::kSize, {&spot.radius_m, 1}, Range{0.0, 1.0}, !flat},
          {"cone_deg", NumberRole::kAngle, {&spot.cone_deg, 1}, Range{1.0, double{kWidestCone_deg}}},
          {"inner_cone_deg", NumberRole::kAngle, {&spot.inner_cone_deg, 1}},
          {"size", NumberRole::kSize, {&spot.size_m.x, 2}, Range{0.01, 2.0}, flat}};
}

int count_layers(const Spot&, const MapWindow*, const FitRule&) { return 1; }

std::vector<LightFrustum> fit_layers(const Spot& spot, const MapWindow*, const Scene& scene,
                                     const FitRequest& request) {
  const Beam beam = *find_beam(spot);
  const double tangent = pad_tangent(std::tan(0.5 * glm::radians(static_cast<double>(spot.cone_deg))), request);
  return {fit_perspective(beam, tangent, find_extent(scene, look_along(beam), tangent), request)};
}

}  // namespace shadowbench::scene
