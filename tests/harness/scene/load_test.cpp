#include "harness/scene/load.h"

#include "harness/scene/complete.h"
#include "harness/scene/lights/light_fit.h"
#include "tests/harness/scene/gltf_parts.h"

namespace shadowbench::scene {
namespace {

const std::filesystem::path kScenes = std::filesystem::path(SHADOWBENCH_SOURCE_DIR) / "data" / "scenes";
constexpr double kAspect = 16.0 / 9.0;

LoadOptions make_options(bool ground = false) {
  return {.scenes_folder = kScenes, .ground = ground, .aspect = kAspect};
}

/// Where the camera sees a point: x and y in [-1,1] inside the picture, z ahead.
glm::dvec3 seen_at(const Camera& camera, const glm::vec3& p) {
  const glm::dvec3 forward(camera.forward_ws);
  const glm::dvec3 right = glm::normalize(glm::cross(forward, glm::dvec3(camera.up_ws)));
  const glm::dvec3 offset = glm::dvec3(p) - glm::dvec3(camera.position_ws);
  const double ahead = glm::dot(offset, forward);
  const double tangent = std::tan(0.5 * static_cast<double>(camera.vertical_fov_rad));
  const double y = glm::dot(offset, glm::cross(right, forward)) / (ahead * tangent);
  return {glm::dot(offset, right) / (ahead * tangent * kAspect), y, ahead};
}

std::filesystem::path write_tower(const TestFolder& folder) {
  return folder.write("tower.obj",
                      "v 0 1 0\nv 1 1 0\nv 1 1 1\nv 0 1 1\nv 0 4 0\nv 1 4 0\nv 1 4 1\nv 0 4 1\n"
                      "f 1 2 3 4\nf 5 8 7 6\nf 1 5 6 2\nf 2 6 7 3\nf 3 7 8 4\nf 4 8 5 1\n");
}

TEST(LoadTest, BuiltInScenes_AreFoundInOrder) {
  std::vector<std::string> names;
  for (const SceneInfo& info : list_scenes(kScenes)) {
    names.push_back(info.name);
    EXPECT_FALSE(info.title.empty());
  }
  EXPECT_THAT(names, testing::IsSupersetOf({"ball", "cubes", "fence", "stack", "steps"}));
  EXPECT_TRUE(std::ranges::is_sorted(names));
}

TEST(LoadTest, TeachingScenes_AreFoundByNameAndNotAmongTheOthers) {
  std::vector<std::string> names;
  for (const SceneInfo& info : list_teaching_scenes(kScenes)) {
    names.push_back(info.name);
    EXPECT_FALSE(info.title.empty());
    EXPECT_TRUE(load(info.name, make_options()).warnings.empty());
  }
  EXPECT_THAT(names, testing::IsSupersetOf({"edge", "lamp"}));
  for (const SceneInfo& info : list_scenes(kScenes)) EXPECT_THAT(names, Not(Contains(info.name)));
  EXPECT_TRUE(list_teaching_scenes(kScenes / "nowhere").empty());
  LoadOptions options = make_options();
  EXPECT_THAT(error_of([&] { load("edges", options); }).message(), HasSubstr("did you mean 'edge'"));
}

TEST(LoadTest, BuiltInScenes_LoadWithoutWarningsOnASmallFloor) {
  for (const SceneInfo& info : list_scenes(kScenes)) {
    SCOPED_TRACE(info.name);
    const Scene scene = load(info.name, make_options());
    EXPECT_EQ(scene.name, info.name);
    EXPECT_TRUE(scene.warnings.empty());
    const glm::vec3 size = scene.bounds().max - scene.bounds().min;
    EXPECT_LT(std::max(size.x, size.z), 14.0f);
    EXPECT_NEAR(scene.bounds().min.y, 0.0f, 0.01f);
    EXPECT_GT(to_light(scene.light, {}).y, 0.0f);
  }
}

TEST(LoadTest, WhatCannotBeLoaded_IsRefused) {
  const TestFolder folder;
  std::filesystem::create_directory(folder.path() / "x.gltf");
  for (const auto& [name, kind, words] : std::initializer_list<std::tuple<std::string, ErrorKind, const char*>>{
           {"cube", ErrorKind::kUsage, "did you mean 'cubes'"},
           {"cathedral", ErrorKind::kUsage, "built-in scenes: ball, cubes"},
           {"model.fbx", ErrorKind::kUsage, ".gltf"},
           {(folder.path() / "x.gltf").string(), ErrorKind::kInput, ""}})
    EXPECT_THAT(error_of([&, name = name] { load(name, make_options()); }), is_error(kind, words)) << name;
  for (const std::string path : {"nowhere/model.gltf", "absent.glb", "absent.obj", "absent.toml", "./cubes.toml"})
    EXPECT_THAT(error_of([&] { load(path, make_options()); }), is_error(ErrorKind::kInput, path)) << path;
}

TEST(LoadTest, EmptyOrMeaninglessFiles_AreInputErrors) {
  const TestFolder folder;
  for (const std::string name : {"a.gltf", "a.glb", "a.obj", "a.toml"}) {
    for (const std::string& content : {std::string(), std::string("\x7f"
                                                                  "ELF nonsense\n\0\1\2",
                                                                  16)}) {
      const auto file = folder.write(name, content);
      EXPECT_EQ(error_of([&] { load(file.string(), make_options()); }).kind(), ErrorKind::kInput) << name;
    }
  }
}

TEST(LoadTest, BareModel_FillsThePictureAndFitsInside) {
  const TestFolder folder;
  const Scene scene = load(write_tower(folder).string(), make_options());
  glm::dvec2 low(2.0);
  glm::dvec2 high(-2.0);
  for (const Mesh& mesh : scene.meshes) {
    for (const Vertex& vertex : mesh.vertices) {
      const glm::dvec3 seen = seen_at(scene.cameras[0], vertex.position_ws);
      ASSERT_GT(seen.z, 0.0);
      low = glm::min(low, glm::dvec2(seen));
      high = glm::max(high, glm::dvec2(seen));
    }
  }
  EXPECT_GT(low.y, -1.0);
  EXPECT_LT(high.y, 1.0);
  EXPECT_GT(std::max(high.x - low.x, high.y - low.y), 1.85);
  EXPECT_NEAR(low.y + high.y, 0.0, 0.01);
}

TEST(LoadTest, BareModel_HasASunFromAboveAcrossTheView) {
  const TestFolder folder;
  const Scene scene = load(write_tower(folder).string(), make_options());
  EXPECT_NEAR(to_light(scene.light, {}).y, std::sin(glm::radians(50.0f)), 1e-5f);
  EXPECT_LT(std::abs(glm::dot(glm::vec2(to_light(scene.light, {}).x, to_light(scene.light, {}).z),
                              glm::vec2(scene.cameras[0].forward_ws.x, scene.cameras[0].forward_ws.z))),
            0.3f);
}

TEST(LoadTest, Ground_LiesJustBelowTheModelAndCatchesItsShadow) {
  const TestFolder folder;
  const std::string file = write_tower(folder).string();
  const Scene bare = load(file, make_options());
  const Scene scene = load(file, make_options(true));
  ASSERT_EQ(scene.meshes.size(), bare.meshes.size() + 1);
  const Mesh& floor = scene.meshes.back();
  EXPECT_EQ(floor.name, "ground");
  EXPECT_NE(scene.materials[static_cast<std::size_t>(floor.material)].base_color, bare.materials[0].base_color);
  Bounds box;
  for (const Vertex& v : floor.vertices) box.add(v.position_ws);
  EXPECT_LT(box.max.y, bare.bounds().min.y);
  EXPECT_GT(box.max.y, bare.bounds().min.y - 0.01f);
  for (const Vertex& v : bare.meshes[0].vertices) {
    const glm::vec3 shadow =
        v.position_ws + to_light(scene.light, {}) * ((box.max.y - v.position_ws.y) / to_light(scene.light, {}).y);
    EXPECT_TRUE(shadow.x > box.min.x && shadow.x < box.max.x && shadow.z > box.min.z && shadow.z < box.max.z);
    const glm::dvec3 seen = seen_at(scene.cameras[0], shadow);
    EXPECT_LT(std::max(std::abs(seen.x), std::abs(seen.y)), 1.0);
  }
}

TEST(LoadTest, GroundUnderASceneFile_IsIgnoredWithAWarning) {
  const Scene scene = load("cubes", make_options(true));
  EXPECT_EQ(scene.meshes.size(), load("cubes", make_options()).meshes.size());
  EXPECT_THAT(scene.warnings, ElementsAre(HasSubstr("bare models")));
}

TEST(LoadTest, LongScene_IsSeenFromItsEnd) {
  const TestFolder folder;
  const auto file = folder.write("row.obj", "v 0 0 0\nv 100 0 0\nv 100 2 1\nf 1 2 3\n");
  const Camera camera = load(file.string(), make_options()).cameras[0];
  EXPECT_GT(std::abs(camera.forward_ws.x), 2.0f * std::abs(camera.forward_ws.z));
}

TEST(LoadTest, LightsOfIntensity0_AreLeftOut) {
  const TestFolder folder;
  const auto load_with = [&](const std::string& lights) {
    return load(folder
                    .write("dark.toml", "title = \"dark\"\n" + lights +
                                            "[[object]]\nshape = \"plane\"\nsize = [1, 1]\n"
                                            "[[camera]]\nname = \"a\"\nposition = [0, 2, 2]\ntarget = [0, 0, 0]\n"
                                            "[[camera]]\nname = \"b\"\nlight = \"off\"\nposition = [0, 2, 3]\n"
                                            "target = [0, 0, 0]\n")
                    .string(),
                make_options());
  };
  const std::string angles = "azimuth_deg = 10\nelevation_deg = 20\n";
  const std::string off = "[[light]]\nname = \"off\"\nintensity = 0\n" + angles;
  const std::string on = "[[light]]\nname = \"on\"\nintensity = 0.001\n" + angles;
  const auto warning = HasSubstr("the light 'off' has an intensity of 0; it is left out");
  for (const std::string& lights : {off + on, on + off}) {
    const Scene scene = load_with(lights);
    EXPECT_EQ(scene.light.name, "on");
    EXPECT_TRUE(scene.other_lights.empty());
    ASSERT_EQ(scene.cameras.size(), 1U) << "the other camera looks at the light that is left out";
    EXPECT_EQ(scene.cameras[0].name, "a");
    EXPECT_THAT(scene.warnings, ElementsAre(warning));
  }
  const Scene scene = load_with(off);
  EXPECT_GT(scene.light.intensity, 0.0f) << "a sun takes its place";
  EXPECT_THAT(scene.warnings, Contains(warning));
}

TEST(LoadTest, LightOfAModelOfIntensity0_IsLeftOut) {
  const TestFolder folder;
  const GltfParts parts = lit_parts(
      {{R"({"type": "point", "name": "off", "intensity": 0})", ""}, {R"({"type": "directional", "name": "on"})", ""}});
  folder.write("data.bin", parts.buffer);
  const Scene scene = load(folder.write("dark.gltf", gltf_of(parts)).string(), make_options());
  EXPECT_EQ(scene.light.name, "on");
  EXPECT_TRUE(scene.other_lights.empty());
  EXPECT_THAT(scene.warnings, Contains(HasSubstr("the light 'off' has an intensity of 0; it is left out")));
}

TEST(WalkThrough, StandsOnTheFloorOfRealModels_AndLooksAlongThem) {
  const char* folder = std::getenv("SHADOWBENCH_SCENES");
  if (!folder) GTEST_SKIP() << "SHADOWBENCH_SCENES does not name the folder of real models";
  for (const char* name : {"dxsdk_shadow_columns", "japanese_bridge_garden"}) {
    SCOPED_TRACE(name);
    const Scene scene =
        load((std::filesystem::path(folder) / name / (std::string(name) + ".gltf")).string(), make_options(false));
    const Camera camera = find_walk_through(scene).value();
    const Bounds bounds = scene.bounds();
    const glm::vec3 size = bounds.max - bounds.min;
    for (int axis = 0; axis < 3; ++axis) {
      EXPECT_GT(camera.position_ws[axis], bounds.min[axis]);
      EXPECT_LT(camera.position_ws[axis], bounds.max[axis]);
    }
    EXPECT_LT(camera.position_ws.y - bounds.min.y, 0.75f * size.y);
    const auto seen = list_visible_corners(scene, camera, 16.0 / 9.0);
    const DepthSpan depths = find_depth_span(camera, seen);
    EXPECT_GT(depths.far_m - std::max(depths.near_m, 0.0), 0.7 * static_cast<double>(std::max(size.x, size.z)));
    const bool is_own = scene.cameras[0].position_ws == camera.position_ws;
    EXPECT_EQ(is_own, size.x > 3.0f * size.z) << "one looks at a garden from outside";
  }
}

}  // namespace
}  // namespace shadowbench::scene
