#pragma once

#include <gtest/gtest.h>

#include <cstring>

#include "harness/scene/load.h"

namespace shadowbench::test {

/// A built-in scene as its file has it.
inline scene::Scene load_own_scene(const std::string& name) {
  return scene::load(name, {.scenes_folder = std::filesystem::path(SHADOWBENCH_SOURCE_DIR) / "data" / "scenes"});
}

/// Whether a place in a map, u and v in texels, keeps this distance from its border.
inline bool is_padded(const glm::dvec3& place, double map_size, double pad) {
  return std::min(place.x, place.y) >= pad - 1e-3 && std::max(place.x, place.y) <= map_size - pad + 1e-3;
}

inline void expect_padded(const glm::dvec3& place, double map_size, double pad) {
  EXPECT_TRUE(is_padded(place, map_size, pad)) << place.x << " " << place.y;
  EXPECT_GT(place.z, 0.0);
  EXPECT_LT(place.z, 1.0);
}

/// Expects the same triangles in the same order, and the same materials on them, float for float.
inline void expect_same_geometry(const scene::Scene& a, const scene::Scene& b) {
  ASSERT_EQ(a.meshes.size(), b.meshes.size());
  for (std::size_t i = 0; i < a.meshes.size(); ++i) {
    const scene::Mesh &left = a.meshes[i], &right = b.meshes[i];
    EXPECT_EQ(left.name, right.name);
    ASSERT_EQ(left.indices, right.indices) << left.name;
    ASSERT_EQ(left.vertices.size(), right.vertices.size()) << left.name;
    EXPECT_EQ(std::memcmp(left.vertices.data(), right.vertices.data(), left.vertices.size() * sizeof(scene::Vertex)), 0)
        << left.name;
    EXPECT_EQ(left.casts_shadow, right.casts_shadow) << left.name;
    const auto& painted_left = a.materials[static_cast<std::size_t>(left.material)];
    const auto& painted_right = b.materials[static_cast<std::size_t>(right.material)];
    EXPECT_EQ(painted_left.name, painted_right.name);
    EXPECT_EQ(painted_left.base_color, painted_right.base_color) << painted_left.name;
    EXPECT_EQ(painted_left.base_color_texture, painted_right.base_color_texture) << painted_left.name;
  }
  EXPECT_EQ(a.textures.size(), b.textures.size());
  EXPECT_EQ(a.background, b.background);
}

inline void expect_same_camera(const scene::Camera& a, const scene::Camera& b) {
  EXPECT_EQ(a.name, b.name);
  EXPECT_EQ(a.position_ws, b.position_ws) << a.name;
  EXPECT_EQ(a.forward_ws, b.forward_ws) << a.name;
  EXPECT_EQ(a.up_ws, b.up_ws) << a.name;
  EXPECT_EQ(a.vertical_fov_rad, b.vertical_fov_rad) << a.name;
  EXPECT_EQ(a.orthographic_height_m, b.orthographic_height_m) << a.name;
}

/// By what the name of a cell is made from, which holds every number of a light.
inline void expect_same_light(const scene::Light& a, const scene::Light& b) {
  EXPECT_EQ(a.name, b.name);
  EXPECT_EQ(scene::list_light_content(a), scene::list_light_content(b)) << a.name;
}

/// The lights of a scene in its own order.
inline std::vector<scene::Light> list_lights(const scene::Scene& scene) {
  std::vector<scene::Light> lights = {scene.light};
  lights.insert(lights.end(), scene.other_lights.begin(), scene.other_lights.end());
  return lights;
}

/// Expects that a loaded scene has exactly these cameras and lights.
inline void expect_views(const scene::Scene& loaded, const std::vector<scene::Camera>& cameras,
                         const std::vector<scene::Light>& lights) {
  ASSERT_EQ(loaded.cameras.size(), cameras.size());
  for (std::size_t i = 0; i < cameras.size(); ++i) expect_same_camera(loaded.cameras[i], cameras[i]);
  const std::vector<scene::Light> own = list_lights(loaded);
  ASSERT_EQ(own.size(), lights.size());
  for (std::size_t i = 0; i < lights.size(); ++i) expect_same_light(own[i], lights[i]);
}

}  // namespace shadowbench::test
