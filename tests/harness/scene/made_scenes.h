#pragma once

// Scenes that a test makes of a few meshes.

#include <glm/gtc/matrix_transform.hpp>
#include <utility>
#include <vector>

#include "harness/scene/mesh_tools.h"
#include "harness/scene/scene.h"

namespace shadowbench::scene {

inline Mesh move_mesh(const Mesh& mesh, const glm::dvec3& by) {
  return transform_mesh(mesh, glm::translate(glm::dmat4(1.0), by));
}

inline Camera make_camera(const glm::vec3& from, const glm::vec3& along, const glm::vec3& up = {0, 1, 0}) {
  Camera camera;
  camera.position_ws = from;
  camera.forward_ws = glm::normalize(along);
  camera.up_ws = up;
  return camera;
}

/// A camera that looks straight down: in perspective, or on so many metres.
inline Camera look_down(const glm::vec3& from, float orthographic_height_m = 0.0f) {
  Camera camera = make_camera(from, {0, -1, 0}, {0, 0, -1});
  camera.orthographic_height_m = orthographic_height_m;
  return camera;
}

inline const Sun kSunAtZenith{{0.0f, -1.0f, 0.0f}};

/// Meshes of one material.
inline Scene make_scene_of(std::vector<Mesh> meshes, LightKind light = {}, std::vector<Camera> cameras = {}) {
  Scene scene;
  scene.materials.emplace_back();
  scene.meshes = std::move(meshes);
  scene.light.kind = std::move(light);
  scene.cameras = std::move(cameras);
  return scene;
}

/// A square sheet 2 m over a floor, seen from straight above; the sun stands so low that the sheet's shadow lies beside
/// it.
inline Scene make_sheet_over_floor() {
  Scene scene = make_scene_of({make_plane({8.0f, 8.0f}, 1), move_mesh(make_plane({1.0f, 1.0f}, 1), {-2.0, 2.0, 0.0})},
                              {}, {look_down({0.0f, 10.0f, 0.0f}, 6.0f)});
  scene.light = place_in_sky(scene.light, {-90.0, 40.0});
  return scene;
}

}  // namespace shadowbench::scene
