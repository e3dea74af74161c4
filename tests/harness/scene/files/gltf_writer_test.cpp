#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "harness/scene/files/mesh_file.h"
#include "harness/scene/load.h"
#include "harness/scene/scene.h"
#include "tests/harness/scene/gltf_parts.h"

namespace shadowbench::scene {
namespace {

const std::string kOwnScenes = std::string(SHADOWBENCH_SOURCE_DIR) + "/data/scenes";

Scene write_and_read(const Scene& scene) {
  const TestFolder folder;
  return load(folder.write("scene.glb", write_glb(scene, 16.0 / 9.0)).string(), {kOwnScenes});
}

/// Every light of every scene that comes with the program, by itself.
std::vector<Scene> list_lit_scenes() {
  std::vector<Scene> all;
  for (const auto& scenes : {list_scenes(kOwnScenes), list_teaching_scenes(kOwnScenes)})
    for (const SceneInfo& info : scenes)
      for (Scene& lit : separate_lights(load(info.name, {kOwnScenes}))) all.push_back(std::move(lit));
  return all;
}

TEST(GltfWriter, ASceneIsReadAsItWasWritten) {
  for (const Scene& scene : list_lit_scenes()) {
    const Scene read = write_and_read(scene);
    SCOPED_TRACE(scene.name);
    EXPECT_EQ(read.title, scene.title);
    EXPECT_EQ(read.background, scene.background);
    EXPECT_THAT(read.warnings, testing::Each(testing::HasSubstr("blends; cameras see it opaque")));
    ASSERT_EQ(read.meshes.size(), scene.meshes.size());
    for (std::size_t m = 0; m < scene.meshes.size(); ++m) {
      const Mesh &mesh = read.meshes[m], &was = scene.meshes[m];
      EXPECT_EQ(mesh.casts_shadow, was.casts_shadow);
      EXPECT_EQ(mesh.may_cull_front, was.may_cull_front);
      EXPECT_EQ(mesh.indices, was.indices);
      EXPECT_EQ(read.materials[static_cast<std::size_t>(mesh.material)].base_color,
                scene.materials[static_cast<std::size_t>(was.material)].base_color);
      ASSERT_EQ(mesh.vertices.size(), was.vertices.size());
      for (std::size_t v = 0; v < was.vertices.size(); ++v) {
        EXPECT_EQ(mesh.vertices[v].position_ws, was.vertices[v].position_ws);
        EXPECT_NEAR(glm::distance(mesh.vertices[v].normal_ws, was.vertices[v].normal_ws), 0.0f, 1e-6f);
      }
    }
    ASSERT_EQ(read.cameras.size(), scene.cameras.size());
    for (std::size_t c = 0; c < scene.cameras.size(); ++c) {
      EXPECT_EQ(read.cameras[c].position_ws, scene.cameras[c].position_ws);
      EXPECT_NEAR(glm::distance(read.cameras[c].forward_ws, scene.cameras[c].forward_ws), 0.0f, 1e-7f);
      EXPECT_EQ(read.cameras[c].vertical_fov_rad, scene.cameras[c].vertical_fov_rad);
      EXPECT_EQ(read.cameras[c].orthographic_height_m, scene.cameras[c].orthographic_height_m);
    }
    Light back = read.light;
    if (auto* sun = std::get_if<Sun>(&back.kind)) sun->direction_ws += 0.0f;  // makes 0 of -0
    EXPECT_EQ(list_light_content(back).front(), list_light_content(scene.light).front());
  }
}

TEST(GltfWriter, TexturesAndHolesStay) {
  Scene scene = load("cubes", {kOwnScenes});
  scene.textures.push_back({"checker", 2, 1, {255, 0, 0, 255, 0, 255, 0, 7}});
  scene.materials[0].base_color_texture = 0;
  scene.materials[0].alpha_mode = AlphaMode::kMask;
  scene.materials[0].alpha_cutoff = 0.25f;
  const Scene read = write_and_read(scene);
  ASSERT_EQ(read.textures.size(), 1u);
  EXPECT_EQ(read.textures[0].rgba, scene.textures[0].rgba);
  EXPECT_EQ(read.materials[0].alpha_mode, AlphaMode::kMask);
  EXPECT_EQ(read.materials[0].alpha_cutoff, 0.25f);
  EXPECT_EQ(read.materials[0].base_color_texture, 0);
}

TEST(GltfWriter, NamesInOtherEncodings_AreReplaced) {
  Scene scene = load("cubes", {kOwnScenes});
  scene.name = scene.title = scene.materials[0].name = scene.meshes[0].name = scene.light.name = "Gr\xfcn";
  const Scene read = write_and_read(scene);
  for (const std::string& name : {read.title, read.materials[0].name, read.meshes[0].name, read.light.name})
    EXPECT_EQ(name, "Gr\ufffdn");
}

TEST(GltfWriter, WhatBlends_Stays) {
  Scene scene = load("panes", {kOwnScenes});
  const Scene read = write_and_read(scene);
  EXPECT_EQ(read.materials[1].alpha_mode, AlphaMode::kBlend);
  EXPECT_EQ(read.materials[1].base_color.a, 0.3f);
  EXPECT_EQ(read.materials[0].alpha_mode, AlphaMode::kOpaque);
}

TEST(GltfWriter, ExtrasThatASceneFileDoesNotTake_AreRefused) {
  const TestFolder folder;
  std::string text = write_glb(load("cubes", {kOwnScenes}), 1.5);
  const std::string key = "angular_diameter_deg";
  ASSERT_NE(text.find(key), std::string::npos);
  text.replace(text.find(key), key.size(), "angular_diameter_rad");
  try {
    load(folder.write("scene.glb", text).string(), {kOwnScenes});
    FAIL() << "it was read";
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("angular_diameter_rad"));
  }
}

}  // namespace
}  // namespace shadowbench::scene
