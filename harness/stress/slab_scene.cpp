#include "harness/stress/slab_scene.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

#include "harness/scene/mesh_tools.h"
#include "harness/scene/primitives.h"

namespace shadowbench::stress {
namespace {

constexpr double kFloor_m = 4.0, kHeight_m = 1.0, kWall_m = 1.2;
constexpr double kSlabTurnDeg = 20.0;  // edges that no texel grid follows
constexpr double kSurface_m = 0.01;    // points so near to a surface belong to it
constexpr glm::dvec2 kHalfSlab_m{0.75, 0.5};

glm::dmat4 local_from_slab() {
  return glm::rotate(glm::translate(glm::dmat4(1.0), glm::dvec3(0.2, kHeight_m, -0.1)), glm::radians(kSlabTurnDeg),
                     glm::dvec3(0.0, 1.0, 0.0));
}

glm::dmat4 local_from_wall() {
  const glm::dmat4 moved = glm::translate(glm::dmat4(1.0), glm::dvec3(-0.5 * kFloor_m, 0.5 * kWall_m, 0.0));
  return glm::rotate(moved, glm::radians(-90.0), glm::dvec3(0.0, 0.0, 1.0));
}

scene::Camera make_camera(const glm::dmat3& world_from_local) {
  const glm::dvec3 eye(2.6, 3.6, 3.4), target(-0.2, 0.3, 0.0);
  const glm::dvec3 forward = glm::normalize(target - eye);
  const glm::dvec3 right = glm::normalize(glm::cross(forward, glm::dvec3(0.0, 1.0, 0.0)));
  scene::Camera camera;
  camera.position_ws = glm::vec3(world_from_local * eye);
  camera.forward_ws = glm::vec3(world_from_local * forward);
  camera.up_ws = glm::vec3(world_from_local * glm::cross(right, forward));
  return camera;
}

}  // namespace

scene::Scene make_slab_scene(const SlabSetting& setting) {
  const glm::dmat4 world(setting.world_from_local);
  scene::Scene scene;
  scene.name = "slab";
  scene.materials.emplace_back();
  const glm::vec2 slab(2.0 * kHalfSlab_m), floor(static_cast<float>(kFloor_m)),
      wall(static_cast<float>(kWall_m), static_cast<float>(kFloor_m));
  scene.meshes.push_back(scene::transform_mesh(scene::make_plane(floor, 8), world));
  scene.meshes.push_back(scene::transform_mesh(scene::make_plane(slab, 4), world * local_from_slab()));
  if (setting.wall) {
    scene.meshes.push_back(scene::transform_mesh(scene::make_plane(wall, 4), world * local_from_wall()));
    scene.meshes.back().casts_shadow = false;
  }
  scene.light.kind = scene::Sun{glm::vec3(setting.world_from_local * glm::normalize(setting.light_local))};
  scene.cameras.push_back(make_camera(setting.world_from_local));
  return scene;
}

std::optional<double> find_slab_visibility(const SlabSetting& setting, const glm::dvec3& position_ws, double margin_m) {
  const glm::dvec3 p = glm::transpose(setting.world_from_local) * position_ws;
  if (p.x < kSurface_m - 0.5 * kFloor_m) return std::nullopt;
  if (std::abs(p.y - kHeight_m) < kSurface_m) return 1.0;
  if (std::abs(p.y) > kSurface_m) return std::nullopt;
  const glm::dvec3 hit = p + setting.light_local * ((kHeight_m - p.y) / setting.light_local.y);
  const glm::dvec3 on_slab(glm::inverse(local_from_slab()) * glm::dvec4(hit, 1.0));
  const double outside = std::max(std::abs(on_slab.x) - kHalfSlab_m.x, std::abs(on_slab.z) - kHalfSlab_m.y);
  if (std::abs(outside) < margin_m) return std::nullopt;
  return outside > 0.0 ? 1.0 : 0.0;
}

}  // namespace shadowbench::stress
