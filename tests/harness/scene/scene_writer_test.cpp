#include "harness/scene/scene_writer.h"

#include <gmock/gmock.h>

#include <random>

#include "harness/scene/complete.h"
#include "harness/scene/load.h"
#include "tests/harness/scene/gltf_parts.h"
#include "tests/harness/scene/same_scene.h"

namespace shadowbench::scene {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

constexpr const char* kSceneFolder = SHADOWBENCH_SOURCE_DIR "/data/scenes";

std::vector<fs::path> list_all_scenes() {
  std::vector<fs::path> files;
  for (const SceneInfo& info : list_scenes(kSceneFolder)) files.push_back(info.file);
  for (const SceneInfo& info : list_teaching_scenes(kSceneFolder)) files.push_back(info.file);
  return files;
}

/// A scene as it is shown after every camera and light was moved a little.
struct Moved {
  Scene scene;
  ShownScene shown;

  Moved(const fs::path& source, bool ground, unsigned seed)
      : scene(load(source.string(), {.scenes_folder = kSceneFolder, .ground = ground})) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> step(-0.3f, 0.3f);
    const auto move = [&](glm::vec3 v) { return v + glm::vec3(step(random), step(random), step(random)); };
    shown = {source, &scene, scene.cameras, test::list_lights(scene)};
    for (Camera& camera : shown.cameras) {
      camera.position_ws = move(camera.position_ws);
      camera.forward_ws = glm::normalize(move(camera.forward_ws));
      camera.up_ws = move(camera.up_ws);
      if (camera.orthographic_height_m == 0.0f) camera.vertical_fov_rad *= 1.0f + 0.1f * step(random);
      const Camera settled = settle(camera);
      EXPECT_LT(glm::distance(settled.forward_ws, camera.forward_ws), 2e-7f);
      camera.forward_ws = settled.forward_ws;
      camera.up_ws = settled.up_ws;
      test::expect_same_camera(settled, camera);
    }
    for (Light& light : shown.lights) {
      light = turn_light(light, [&](const glm::vec3& v) { return glm::normalize(move(v)); });
      light.intensity += step(random);
      test::expect_same_light(settle(light), light);
    }
  }

  /// Saves it, loads it again, and expects no difference.
  std::string expect_same_after(const fs::path& file) const {
    const std::string text = write_scene(shown, file);
    fs::create_directories(file.parent_path());
    std::ofstream(file, std::ios::binary) << text;
    const Scene loaded = load(file.string(), {.scenes_folder = kSceneFolder});
    test::expect_same_geometry(loaded, scene);
    test::expect_views(loaded, shown.cameras, shown.lights);
    EXPECT_EQ(loaded.title, scene.title);
    return text;
  }
};

TEST(SceneWriterTest, EveryBuiltInScene_ComesBackAsItWasMoved) {
  const TestFolder folder;
  for (const fs::path& file : list_all_scenes())
    for (const unsigned seed : {1u, 2u, 3u}) {
      SCOPED_TRACE(file.stem().string());
      Moved(file, false, seed).expect_same_after(folder.path() / "deep" / "saved.toml");
    }
}

TEST(SceneWriterTest, SettledDirections_StayAsTheyAre) {
  std::mt19937 random(5);
  std::normal_distribution<float> any;
  int changed = 0;
  for (int i = 0; i < 2000; ++i) {
    Camera camera;
    camera.position_ws = 100.0f * glm::vec3(any(random), any(random), any(random));
    camera.forward_ws = glm::normalize(glm::vec3(any(random), any(random), any(random)));
    Light light;
    light.kind = Sun{glm::normalize(glm::vec3(any(random), any(random), any(random)))};
    const Camera settled = settle(camera);
    const Light settled_light = settle(light);
    test::expect_same_camera(settle(settled), settled);
    test::expect_same_light(settle(settled_light), settled_light);
    EXPECT_LT(glm::distance(settled.forward_ws, camera.forward_ws), 2e-7f);
    changed += settled.forward_ws != camera.forward_ws;
  }
  EXPECT_GT(changed, 0) << "nothing is left to settle";
}

TEST(SceneWriterTest, BareModel_IsSavedWithItsFloorCamerasAndLights) {
  const TestFolder folder;
  GltfParts parts;
  parts.more = R"(, "extensionsUsed": ["KHR_lights_punctual"], "extensions": {"KHR_lights_punctual": {"lights": [
      {"type": "spot", "name": "lamp", "color": [1, 0.5, 0.25], "spot": {"innerConeAngle": 0.25, "outerConeAngle": 0.5}},
      {"type": "directional"}, {"type": "point"}]}}, "cameras": [
      {"type": "perspective", "perspective": {"yfov": 0.01, "znear": 0.1}},
      {"type": "orthographic", "orthographic": {"xmag": 3, "ymag": 2.1, "znear": 0, "zfar": 10}}])";
  parts.nodes = R"([{"mesh": 0, "rotation": [0.1, 0.2, 0.3, 0.9]}, {"extensions": {"KHR_lights_punctual": {"light": 0}},
      "translation": [1, 5, 2], "rotation": [-0.70710678118654752, 0, 0, 0.70710678118654752]},
      {"extensions": {"KHR_lights_punctual": {"light": 1}}, "rotation": [-0.6, 0.1, 0.3, 0.7]},
      {"extensions": {"KHR_lights_punctual": {"light": 2}}, "translation": [1, 2, 3]},
      {"camera": 0, "translation": [0.3, 0.4, 9]}, {"camera": 1, "translation": [0.3, 0.4, 9]}])";
  parts.scenes = R"([{"nodes": [0, 1, 2, 3, 4, 5]}])";
  folder.write("models/data.bin", parts.buffer);
  const fs::path model = folder.write("models/quad.gltf", gltf_of(parts));
  for (const bool ground : {false, true}) {
    const Moved moved(model, ground, 7);
    EXPECT_EQ(moved.scene.floor.has_value(), ground);
    const std::string text = moved.expect_same_after(folder.path() / "saved" / "quad.toml");
    EXPECT_THAT(text, HasSubstr("'../models/quad.gltf'"));
    EXPECT_THAT(text, HasSubstr("orthographic_height"));
  }
  GltfParts bare;
  folder.write("models/data.bin", bare.buffer);
  Moved(folder.write("models/bare.gltf", gltf_of(bare)), true, 8)
      .expect_same_after(folder.path() / "models" / "bare.toml");
}

TEST(SceneWriterTest, FloorOfAModel_IsThatOfAPlane) {
  const Floor floor{{1.7f, 0.3f}, {0.1f, -0.7f, 1e-3f}};
  const TestFolder folder;
  const fs::path file = folder.write(
      "plane.toml",
      fmt::format("title = 't'\n[light]\ndirection = [0, -1, 0]\n[[object]]\nshape = 'plane'\nname = 'ground'\n"
                  "cells = {}\nsize = [1.7, 0.3]\ncenter = [{}, {}, {}]\n",
                  kFloorCells, double{floor.center_ws.x}, double{floor.center_ws.y}, double{floor.center_ws.z}));
  Scene made = load_scene(file);
  const Scene plane = made;
  made.meshes = {make_floor(floor)};
  test::expect_same_geometry(made, plane);
}

TEST(SceneWriterTest, PathsHoldFromTheNewPlace_ThroughLinksToo) {
  const TestFolder folder;
  folder.write("models/tri.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  folder.write("pictures/star.tga", tga_bytes());
  const fs::path source = folder.write("scenes/a.toml",
                                       "title = 'One \"quoted\" caf\u00e9'\nmodel = '../models/tri.obj'\n[light]\n"
                                       "type = 'spot'\nposition = [0, 3, 0]\ntarget = [0, 0, 0]\nsize = [0.3, 0.1]\n"
                                       "cookie = '../pictures/star.tga'\n[[object]]\nshape = 'model'\n"
                                       "file = '../models/tri.obj'\ncenter = [0, 0, 1]\n");
  const Moved moved(source, false, 3);
  EXPECT_THAT(moved.expect_same_after(folder.path() / "new" / "far" / "b.toml"), HasSubstr("'../../models/tri.obj'"));
  fs::create_directories(folder.path() / "real");
  fs::create_directories(folder.path() / "x" / "y");
  fs::create_directory_symlink(folder.path() / "real", folder.path() / "x" / "y" / "link");
  EXPECT_THAT(moved.expect_same_after(folder.path() / "x" / "y" / "link" / "b.toml"),
              HasSubstr("'" + (fs::canonical(folder.path()) / "models" / "tri.obj").string() + "'"));
}

TEST(SceneWriterTest, LinkToAModel_IsNotFollowed) {
  const TestFolder folder;
  const fs::path elsewhere = folder.write("store/a.obj", "");
  fs::create_directories(folder.path() / "models");
  fs::create_symlink(elsewhere, folder.path() / "models" / "tri.obj");
  EXPECT_EQ(name_from(folder.path() / "models" / "tri.obj", folder.path() / "s.toml"), "models/tri.obj");
}

TEST(SceneWriterTest, MapWindowAndNames_AreKept) {
  const TestFolder folder;
  const fs::path source = folder.write("w.toml", R"(title = "windows"
[[camera]]
name = "it's"
position = [0, 2, 5]
target = [0, 0, 0]
[[camera]]
name = "b \"q\""
position = [0, 2, 5]
target = [0, 0, 1]
[light]
name = "sun"
direction = [0, -1, 0.3]
color = [0.1, 0.7, 0.3]
map_center = [0.1, 0.2, 0.30000000000000004]
map_width = 3.3
map_near = -1.5
map_far = 2.2
[object]
shape = "sphere"
radius = 0.7
)");
  const Moved moved(source, false, 9);
  ASSERT_TRUE(moved.shown.lights[0].map_window && moved.shown.lights[0].map_window->planes);
  moved.expect_same_after(folder.path() / "saved.toml");
}

TEST(SceneWriterTest, WhatNoFileTakes_IsRefusedByName) {
  Camera camera;
  camera.name = "far";
  camera.vertical_fov_rad = 3.14f;
  const Error error = error_of([&] { settle(camera); });
  EXPECT_EQ(error.kind(), ErrorKind::kInput);
  EXPECT_THAT(error.message(), testing::AllOf(HasSubstr("camera 'far'"), HasSubstr("'vertical_fov_deg'")));
}

}  // namespace
}  // namespace shadowbench::scene
