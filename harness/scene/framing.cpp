#include "harness/scene/framing.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <limits>
#include <utility>
#include <vector>

#include "harness/scene/mesh_tools.h"
#include "harness/scene/primitives.h"

namespace shadowbench::scene {
namespace {

constexpr double kCameraAzimuthDeg = 30.0;
constexpr double kCameraOffLongAxisDeg = 14.0;
constexpr double kCameraElevationDeg = 24.0;
constexpr double kVerticalFovDeg = 40.0;
constexpr double kMargin = 1.04;
constexpr double kSunFromCameraDeg = 80.0;
constexpr double kSunElevationDeg = 50.0;

constexpr float kElongated = 3.0f;

/// The azimuth of the long axis of a scene that is much longer than wide; others have none.
std::optional<double> long_axis_deg(const Bounds& bounds) {
  const glm::vec3 size = bounds.max - bounds.min;
  if (size.x > kElongated * size.z) return 90.0;
  return size.z > kElongated * size.x ? std::optional(0.0) : std::nullopt;
}

/// The camera looks from three quarters, or from near the end of a long scene.
double camera_azimuth_deg(const Bounds& bounds) {
  const std::optional<double> axis_deg = long_axis_deg(bounds);
  if (!axis_deg) return kCameraAzimuthDeg;
  return std::abs(*axis_deg - kCameraOffLongAxisDeg);
}

/// Where the light throws a point on the plane y = ground_y; nothing for a light that does not come from above.
std::optional<glm::dvec3> shadow_of(const glm::vec3& p, const Light& light, float ground_y) {
  constexpr double kLowestSine = 0.1;
  const glm::dvec3 direction = glm::normalize(glm::dvec3(to_light(light, p)));
  if (direction.y < kLowestSine) return std::nullopt;
  return glm::dvec3(p) + direction * ((static_cast<double>(ground_y) - static_cast<double>(p.y)) / direction.y);
}

std::vector<glm::dvec3> points_to_show(const Scene& scene, std::optional<float> ground_y) {
  std::vector<glm::dvec3> points;
  for (const Mesh& mesh : scene.meshes) {
    for (const Vertex& vertex : mesh.vertices) {
      points.emplace_back(vertex.position_ws);
      if (!ground_y) continue;
      if (const auto shadow = shadow_of(vertex.position_ws, scene.light, *ground_y)) points.push_back(*shadow);
    }
  }
  return points;
}

/// The two planes of a frustum that bound one axis of the picture. They touch the points when the eye is at `centre`
/// along the axis and `distance` behind the origin.
struct Slab {
  double low = std::numeric_limits<double>::lowest();
  double high = std::numeric_limits<double>::lowest();
  double tangent;
  void add(double across, double ahead) {
    high = std::max(high, across - tangent * ahead);
    low = std::max(low, -across - tangent * ahead);
  }
  double centre() const { return 0.5 * (high - low); }
  double distance() const { return 0.5 * (high + low) / tangent; }
};

}  // namespace

Camera frame_camera(const Scene& scene, const SkyAngles& from, double aspect, std::optional<float> ground_y) {
  const Bounds bounds = scene.bounds();
  const glm::dvec3 forward = light_direction(from.azimuth_deg, from.elevation_deg);
  const glm::dvec3 right = glm::normalize(glm::cross(forward, glm::dvec3(0.0, 1.0, 0.0)));
  const glm::dvec3 up = glm::cross(right, forward);
  const double tangent = std::tan(0.5 * glm::radians(kVerticalFovDeg)) / kMargin;
  Slab horizontal{.tangent = tangent * aspect};
  Slab vertical{.tangent = tangent};
  double nearest = std::numeric_limits<double>::max();
  for (const glm::dvec3& p : points_to_show(scene, ground_y)) {
    horizontal.add(glm::dot(p, right), glm::dot(p, forward));
    vertical.add(glm::dot(p, up), glm::dot(p, forward));
    nearest = std::min(nearest, glm::dot(p, forward));
  }
  const double gap = 1e-3 * static_cast<double>(glm::length(bounds.max - bounds.min));
  const double distance = std::max({horizontal.distance(), vertical.distance(), gap - nearest});
  Camera camera;
  camera.position_ws = glm::vec3(right * horizontal.centre() + up * vertical.centre() - forward * distance);
  camera.forward_ws = glm::vec3(forward);
  camera.up_ws = glm::vec3(up);
  camera.vertical_fov_rad = static_cast<float>(glm::radians(kVerticalFovDeg));
  return camera;
}

bool would_be_thin(const Bounds& bounds, const SkyAngles& from) {
  constexpr double kFarthestOffDeg = 35.0;
  const glm::vec3 size = bounds.max - bounds.min;
  const std::optional<double> axis_deg = long_axis_deg(bounds);
  if (!axis_deg || std::max(size.x, size.z) <= kElongated * size.y) return false;
  return std::abs(std::cos(glm::radians(from.azimuth_deg - *axis_deg))) <= std::cos(glm::radians(kFarthestOffDeg));
}

ViewAngles usual_view(const Bounds& bounds) {
  const double azimuth_deg = camera_azimuth_deg(bounds);
  return {{azimuth_deg, kCameraElevationDeg}, {azimuth_deg + kSunFromCameraDeg, kSunElevationDeg}};
}

float ground_height(const Scene& scene) {
  constexpr float kGap = 5e-4f;
  const Bounds bounds = scene.bounds();
  const float away_from_rounding = 1e-6f * std::abs(bounds.min.y);
  return bounds.min.y - std::max(kGap * glm::length(bounds.max - bounds.min), away_from_rounding);
}

Floor place_floor(const Scene& scene, float ground_y) {
  constexpr float kBorder = 0.15f;
  Bounds covered;
  for (const glm::dvec3& p : points_to_show(scene, ground_y)) covered.add(glm::vec3(p.x, ground_y, p.z));
  const glm::vec3 size = covered.max - covered.min;
  const float border = 2.0f * kBorder * std::max(size.x, size.z);
  return {{size.x + border, size.z + border}, 0.5f * (covered.min + covered.max)};
}

Mesh make_floor(const Floor& floor) {
  Mesh mesh = without_unused_vertices(transform_mesh(make_plane(floor.size_m, kFloorCells),
                                                     glm::translate(glm::dmat4(1.0), glm::dvec3(floor.center_ws))));
  mesh.name = "ground";
  return mesh;
}

}  // namespace shadowbench::scene
