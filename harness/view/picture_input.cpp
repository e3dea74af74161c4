#include "harness/view/picture_input.h"

#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>

#include "harness/gl/gl_api.h"

// After the loader, see gl_api.h.
#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

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

namespace {

constexpr float kDividerGrip = 6.0f;  ///< pixels on either side
constexpr float kTurnPerPixel_rad = 0.006f;
constexpr double kLightPerPixel_deg = 0.25;
constexpr float kApproachPerNotch = 0.88f;
constexpr float kFlightsPerSecond = 0.25f;  ///< through the whole scene
constexpr float kFaster = 4.0f;

glm::vec2 to_glm(const ImVec2& v) { return {v.x, v.y}; }

float key_axis(const Window& window, int plus, int minus) {
  return (window.is_held(plus) ? 1.0f : 0.0f) - (window.is_held(minus) ? 1.0f : 0.0f);
}

}  // namespace

void PictureInput::take(const PicturePlace& place, Look& look, double seconds) {
  const ImGuiIO& io = ImGui::GetIO();
  const glm::vec2 pointer = to_glm(io.MousePos), by = to_glm(io.MouseDelta);
  const bool any_down = io.MouseDown[0] || io.MouseDown[1] || io.MouseDown[2];
  if (!any_down) grip_ = Grip::kNone;
  const bool is_free = !io.WantCaptureMouse && place.holds(pointer);
  if (is_free && grip_ == Grip::kNone && any_down) {
    grip_ = find_grip(place, look, pointer);
    pivot_ws_ = find_pivot(place.to_picture(pointer));
  }
  if (is_free && find_grip(place, look, pointer) == Grip::kDivider) ImGui::SetMouseCursor(ImGuiMouseCursor_ResizeEW);
  if (grip_ != Grip::kNone) drag(place, look, pointer, by);
  if (is_free && io.MouseWheel != 0.0f)
    set_camera(approach(bench_.state().active_camera(), find_pivot(place.to_picture(pointer)),
                        std::pow(kApproachPerNotch, io.MouseWheel)));
  fly_by_keys(seconds);
}

PictureInput::Grip PictureInput::find_grip(const PicturePlace& place, const Look& look,
                                           const glm::vec2& pointer) const {
  const ImGuiIO& io = ImGui::GetIO();
  if (io.MouseDown[1]) return Grip::kLook;
  if (io.MouseDown[2]) return Grip::kShift;
  if (io.KeyShift) return Grip::kLight;
  const float divider = place.corner.x + place.magnified * place.divider_column(look);
  return std::abs(pointer.x - divider) <= kDividerGrip ? Grip::kDivider : Grip::kOrbit;
}

void PictureInput::drag(const PicturePlace& place, Look& look, const glm::vec2& pointer, const glm::vec2& by) {
  if (grip_ == Grip::kDivider) {
    look.divider = std::clamp(place.to_picture(pointer).x / static_cast<float>(place.pixels.x), 0.0f, 1.0f);
    return;
  }
  if (by == glm::vec2(0.0f)) return;
  const scene::Camera& camera = bench_.state().active_camera();
  const glm::vec2 turn = kTurnPerPixel_rad * by;
  if (grip_ == Grip::kOrbit) return set_camera(orbit(camera, pivot_ws_, -turn.x, turn.y));
  if (grip_ == Grip::kLook) return set_camera(look_around(camera, -turn.x, turn.y));
  if (grip_ == Grip::kShift) {
    // What was grabbed stays under the pointer.
    const float height = camera.orthographic_height_m > 0.0f
                             ? camera.orthographic_height_m
                             : 2.0f * glm::dot(pivot_ws_ - camera.position_ws, camera.forward_ws) *
                                   std::tan(0.5f * camera.vertical_fov_rad);
    const float metres = height / (place.magnified * static_cast<float>(place.pixels.y));
    return set_camera(fly(camera, {-by.x * metres, by.y * metres, 0.0f}));
  }
  bench_.change({.light = true}, [&](ViewSettings& settings) {
    scene::Light& light = settings.lights[settings.light];
    light = move_in_sky(light, kLightPerPixel_deg * static_cast<double>(by.x),
                        -kLightPerPixel_deg * static_cast<double>(by.y));
  });
}

void PictureInput::fly_by_keys(double seconds) {
  const ImGuiIO& io = ImGui::GetIO();
  glm::vec3 way(0.0f);
  if (!io.WantTextInput && !io.KeyCtrl)
    way = {key_axis(window_, GLFW_KEY_D, GLFW_KEY_A), key_axis(window_, GLFW_KEY_E, GLFW_KEY_Q),
           key_axis(window_, GLFW_KEY_W, GLFW_KEY_S)};
  is_flying_ = way != glm::vec3(0.0f);
  if (!is_flying_) return;
  const scene::Bounds bounds = bench_.state().scene.bounds();
  const float speed = kFlightsPerSecond * glm::length(bounds.max - bounds.min) * (io.KeyShift ? kFaster : 1.0f);
  set_camera(fly(bench_.state().active_camera(), way * speed * static_cast<float>(std::min(seconds, 0.1))));
}

void PictureInput::set_camera(const scene::Camera& camera) {
  bench_.change(
      {.camera = true}, [&](ViewSettings& settings) { settings.cameras[settings.camera] = camera; });
}

glm::vec3 PictureInput::find_pivot(const glm::vec2& pixel) const {
  if (const auto place = bench_.stage().find_surface(glm::ivec2(pixel))) return glm::vec3(*place);
  const scene::Bounds bounds = bench_.state().scene.bounds();
  return 0.5f * (bounds.min + bounds.max);
}

}  // namespace shadowbench::view
