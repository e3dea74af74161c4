#include "harness/scene/lights/point.h"

#include <fmt/format.h>

#include <cmath>

#include "harness/scene/lights/perspective_fit.h"
#include "harness/scene/toml_reader.h"
#include "harness/scene/validate.h"

namespace shadowbench::scene {
namespace {

Beam make_face_beam(const PointLight& point, int face) {
  Beam beam = make_beam(point);
  beam.axis_ws = glm::dvec3(0.0);
  beam.axis_ws[face / 2] = face % 2 == 0 ? 1.0 : -1.0;
  return beam;
}

}  // namespace

const std::vector<std::string>& point_keys() {
  static const std::vector<std::string> keys = {"position", "radius", "reference"};
  return keys;
}

PointLight read_point(const TomlTable& table) {
  PointLight point;
  point.position_ws = glm::vec3(table.vec3("position", kAnyNumber));
  point.radius_m = table.number_f("radius", {0.0, 1000.0}, static_cast<double>(point.radius_m));
  point.reference_m = table.number_f("reference", kPositive, 1.0);
  return point;
}

PointLight checked_point(const PointLight& point, const std::string& where) {
  const glm::vec3& p = point.position_ws;
  if (std::isfinite(p.x + p.y + p.z) && std::isfinite(point.radius_m) && point.radius_m >= 0.0f &&
      std::isfinite(point.reference_m) && point.reference_m > 0.0f)
    return point;
  fail_input(fmt::format("the point light stands at ({}, {}, {}), with a radius of {} m and a reference of {} m: the "
                         "place must be finite, the radius 0 or more, the reference more than 0",
                         p.x, p.y, p.z, point.radius_m, point.reference_m),
             where);
}

Beam make_beam(const PointLight& point) {
  constexpr double kEveryCosine = -2.0;
  return {glm::dvec3(point.position_ws),
          {0.0, -1.0, 0.0},
          kEveryCosine,
          kEveryCosine,
          static_cast<double>(point.reference_m)};
}

truth::AreaLight make_area_light(const PointLight& point) {
  return truth::AreaLight::make_disk(glm::dvec3(point.position_ws), {0.0, 1.0, 0.0},
                                     static_cast<double>(point.radius_m));
}

std::vector<LightFrustum> fit_point(const PointLight& point, const Scene& scene, const FitRequest& request) {
  const double tangent = pad_tangent(1.0, request);
  AxisExtent extent;
  for (int face = 0; face < kCubeFaces; ++face)
    extent = extent.joined(find_extent(scene, look_along(make_face_beam(point, face)), tangent));
  std::vector<LightFrustum> faces;
  for (int face = 0; face < kCubeFaces; ++face) {
    faces.push_back(fit_perspective(make_face_beam(point, face), tangent, extent, request));
    faces.back().layer = face;
    faces.back().share = CubeFace{face};
  }
  return faces;
}

}  // namespace shadowbench::scene
