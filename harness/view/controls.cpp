#include "harness/view/controls.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>

namespace shadowbench::view {
namespace {

constexpr double kSteepest_rad = 89.0 / 180.0 * glm::pi<double>();

/// Where a camera looks: to the right of -z, and above the horizon.
struct Gaze {
  double right_rad;
  double up_rad;
};

Gaze find_gaze(const scene::Camera& camera) {
  const glm::dvec3 ahead(camera.forward_ws);
  return {std::atan2(ahead.x, -ahead.z), std::asin(std::clamp(ahead.y, -1.0, 1.0))};
}

glm::dvec3 to_ahead(const Gaze& gaze) {
  return {std::sin(gaze.right_rad) * std::cos(gaze.up_rad), std::sin(gaze.up_rad),
          -std::cos(gaze.right_rad) * std::cos(gaze.up_rad)};
}

Gaze turn(const Gaze& gaze, double right_rad, double up_rad) {
  return {gaze.right_rad + right_rad, std::clamp(gaze.up_rad + up_rad, -kSteepest_rad, kSteepest_rad)};
}

/// The camera's axes, as columns: right, up, ahead.
glm::dmat3 find_axes(const scene::Camera& camera) {
  const glm::dvec3 ahead(camera.forward_ws), right = glm::normalize(glm::cross(ahead, glm::dvec3(camera.up_ws)));
  return {right, glm::cross(right, ahead), ahead};
}

void set_ahead(scene::Camera& camera, const glm::dvec3& ahead) {
  camera.forward_ws = glm::vec3(glm::normalize(ahead));
  camera.up_ws = glm::vec3(0.0f, 1.0f, 0.0f);
}

}  // namespace

scene::Camera orbit(scene::Camera camera, const glm::vec3& pivot_ws, float right_rad, float up_rad) {
  const glm::dvec3 pivot(pivot_ws);
  const glm::dvec3 seen = glm::transpose(find_axes(camera)) * (pivot - glm::dvec3(camera.position_ws));
  // The camera goes to the right as its gaze turns to the left.
  set_ahead(camera, to_ahead(turn(find_gaze(camera), -static_cast<double>(right_rad), -static_cast<double>(up_rad))));
  camera.position_ws = glm::vec3(pivot - find_axes(camera) * seen);
  return camera;
}

scene::Camera look_around(scene::Camera camera, float right_rad, float up_rad) {
  set_ahead(camera, to_ahead(turn(find_gaze(camera), static_cast<double>(right_rad), static_cast<double>(up_rad))));
  return camera;
}

scene::Camera fly(scene::Camera camera, const glm::vec3& way_m) {
  camera.position_ws += glm::vec3(find_axes(camera) * glm::dvec3(way_m));
  return camera;
}

scene::Camera approach(scene::Camera camera, const glm::vec3& pivot_ws, float factor) {
  camera.position_ws = pivot_ws + factor * (camera.position_ws - pivot_ws);
  camera.orthographic_height_m *= factor;
  return camera;
}

scene::SkyAngles find_in_sky(const scene::Light& light) {
  glm::dvec3 travel(0.0);
  scene::turn_light(light, [&](const glm::vec3& direction) {
    travel = glm::dvec3(direction);
    return direction;
  });
  return {glm::degrees(std::atan2(-travel.x, -travel.z)), glm::degrees(std::asin(std::clamp(-travel.y, -1.0, 1.0)))};
}

scene::Light move_in_sky(const scene::Light& light, double azimuth_deg, double elevation_deg) {
  const scene::SkyAngles at = find_in_sky(light);
  return scene::place_in_sky(light,
                             {at.azimuth_deg + azimuth_deg, std::clamp(at.elevation_deg + elevation_deg, -90.0, 90.0)});
}

}  // namespace shadowbench::view
