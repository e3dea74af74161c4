#include "harness/tune/tune_views.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cassert>
#include <glm/gtx/rotate_vector.hpp>

namespace shadowbench::tune {
namespace {

glm::vec3 turn(const glm::vec3& v, double degrees) {
  return glm::vec3(glm::rotateY(glm::dvec3(v), glm::radians(degrees)));
}

}  // namespace

std::string TuneView::name() const {
  std::vector<std::string> turns;
  if (camera_turn_deg != 0.0) turns.push_back(fmt::format("camera {:+g}", camera_turn_deg));
  if (light_turn_deg != 0.0) turns.push_back(fmt::format("light {:+g}", light_turn_deg));
  return turns.empty() ? "as it is" : fmt::format("{}", fmt::join(turns, " "));
}

const std::vector<TuneView>& tune_views() {
  static const std::vector<TuneView> views = {
      {-20.0, 0.0, true}, {0.0, 0.0, true},   {20.0, 0.0, true},   {-30.0, 0.0, false}, {-10.0, 0.0, false},
      {10.0, 0.0, false}, {30.0, 0.0, false}, {0.0, -15.0, false}, {0.0, 15.0, false},
  };
  return views;
}

std::string describe_tune_views(bool training) {
  std::vector<std::string> names;
  for (const TuneView& view : tune_views())
    if (view.training == training) names.push_back(view.name());
  return fmt::format("{}", fmt::join(names, ", "));
}

glm::vec3 find_pivot(const scene::Scene& scene, const scene::Camera& camera) {
  const scene::Bounds bounds = scene.bounds();
  const glm::vec3& eye = camera.position_ws;
  if (glm::all(glm::greaterThan(eye, bounds.min)) && glm::all(glm::lessThan(eye, bounds.max))) return eye;
  const glm::vec3 middle = 0.5f * (bounds.min + bounds.max);
  const float distance = glm::dot(middle - eye, camera.forward_ws);
  return distance > 0.0f ? eye + distance * camera.forward_ws : middle;
}

scene::Camera turn_camera(const scene::Camera& camera, const glm::vec3& pivot_ws, double degrees) {
  scene::Camera turned = camera;
  if (degrees == 0.0) return turned;
  turned.position_ws = pivot_ws + turn(camera.position_ws - pivot_ws, degrees);
  turned.forward_ws = glm::normalize(turn(camera.forward_ws, degrees));
  turned.up_ws = glm::normalize(turn(camera.up_ws, degrees));
  return turned;
}

scene::Scene turn_scene(const scene::Scene& scene, const std::vector<TuneView>& views) {
  assert(!views.empty());
  scene::Scene turned = scene;
  const scene::Camera& camera = scene.cameras.front();
  const glm::vec3 pivot = find_pivot(scene, camera);
  turned.cameras.clear();
  for (const TuneView& view : views) {
    assert(view.light_turn_deg == views.front().light_turn_deg);
    scene::Camera& added = turned.cameras.emplace_back(turn_camera(camera, pivot, view.camera_turn_deg));
    added.name = view.name();
  }
  const double light_turn = views.front().light_turn_deg;
  if (light_turn != 0.0)
    turned.light =
        scene::turn_light(scene.light, [&](const glm::vec3& v) { return glm::normalize(turn(v, light_turn)); });
  return turned;
}

}  // namespace shadowbench::tune
