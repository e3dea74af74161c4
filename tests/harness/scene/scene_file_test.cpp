#include "harness/scene/complete.h"
#include "harness/scene/load.h"
#include "tests/harness/scene/gltf_parts.h"
#include "tests/harness/scene/same_scene.h"

namespace shadowbench::scene {
namespace {

/// A whole scene in eleven lines; the object's table starts on line 7.
constexpr const char* kBase = R"(title = "Test"
[light]
direction = [0, -1, 0]
[camera]
position = [0, 2, 5]
target = [0, 0, 0]
[[object]]
shape = "box"
size = [1, 2, 3]
name = "crate"
center = [0, 1, 0]
)";

Scene load_text(const std::string& text) {
  const TestFolder folder;
  return load(folder.write("test.toml", text).string(), {});
}

struct Complaint {
  std::string message;
  std::string line;
};

Complaint complaint_about(const std::string& text) {
  const Error error = error_of([&] { load_text(text); });
  EXPECT_EQ(error.kind(), ErrorKind::kInput);
  const std::size_t colon = error.where().rfind(".toml:");
  EXPECT_NE(colon, std::string::npos) << error.what();
  return {error.message(), colon == std::string::npos ? "" : error.where().substr(colon + 6)};
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  EXPECT_NE(text.find(from), std::string::npos) << from;
  return text.replace(text.find(from), from.size(), to);
}

TEST(SceneFileTest, WholeScene_HasItsParts) {
  const Scene scene = load_text(kBase);
  EXPECT_EQ(scene.name, "test");
  EXPECT_EQ(scene.title, "Test");
  ASSERT_EQ(scene.meshes.size(), 1U);
  EXPECT_EQ(scene.meshes[0].name, "crate");
  EXPECT_EQ(scene.bounds().min, glm::vec3(-0.5f, 0.0f, -1.5f));
  EXPECT_EQ(scene.bounds().max, glm::vec3(0.5f, 2.0f, 1.5f));
  ASSERT_EQ(scene.cameras.size(), 1U);
  EXPECT_EQ(scene.cameras[0].position_ws, glm::vec3(0, 2, 5));
  EXPECT_EQ(-to_light(scene.light, {}), glm::vec3(0, -1, 0));
  EXPECT_FLOAT_EQ(std::get<Sun>(scene.light.kind).angular_diameter_deg, 0.53f);
}

/// What replaces a part of kBase, or is added to it, what is said of it, and of which line; empty: of any.
struct BadScene {
  const char* from;
  std::string to;
  const char* message;
  const char* line = "";
};

TEST(SceneFileTest, WhatIsWrong_IsSaid_WithItsLine) {
  constexpr const char *kLight = "direction = [0, -1, 0]", *kSize = "[1, 2, 3]",
                       *kShape = "shape = \"box\"\nsize = [1, 2, 3]";
  std::vector<BadScene> scenes{
      {"center", "centre", "did you mean 'center'", "11"},
      {"title", "titel", "'titel'", "1"},
      {"target", "taget", "'taget'", "6"},
      {"direction =", "angle = 1\ndirection =", "'angle'", "3"},
      {"", "radius = 2\n", "unknown key 'radius'"},
      {"size = [1, 2, 3]\n", "", "lacks 'size': expected 3 numbers", "7"},
      {"", "cells = 1.5\n", "whole number"},
      {"", "cells = 0\n", "from 1 to 512"},
      {"", "casts_shadow = 1\n", "true or false"},
      {"", "scale = 0\n", "must not be 0"},
      {kSize, "[1, 2", "not valid TOML"},
      {"box", "bpx", "did you mean 'box'", "8"},
      {"", "material = 'redd'\n[[material]]\nname = 'red'\ncolor = [1, 0, 0]\n", "did you mean 'red'", "12"},
      {kLight, "", "needs a direction"},
      {"[0, -1, 0]", "[0, 0, 0]", "has no direction"},
      {"[0, -1, 0]", "[0, -1, 0]\nazimuth_deg = 1", "either"},
      {"[light]", "[light]\ntype = 'moon'", "'moon'"},
      {kShape, "shape = 'bars'\ncount = 3\nbar_width = 0.5\nspacing = 0.5\nlength = 2", "'bar_width'"},
      {"[0, 2, 5]", "[0, 0, 0]", "", "6"},
      {"", "[[object]]\nshape = 'model'\nfile = 'no.gltf'\n", "no.gltf", "14"},
      {"[camera]", "map_width = 0\nmap_center = [0, 0, 0]\n[camera]", "'map_width'"},
      {"[camera]", "map_width = nan\nmap_center = [0, 0, 0]\n[camera]", "'map_width'"},
      {"[camera]", "map_width = 1\nmap_center = [0, inf, 0]\n[camera]", "'map_center'"},
      {"[camera]", "map_width = 1\n[camera]", "lacks 'map_center'"},
      {"[camera]", "map_center = [0, 0, 0]\n[camera]", "'map_center' in [light] needs 'map_width'"},
      {"[camera]", "map_far = 1\n[camera]", "'map_far' in [light] needs 'map_width'"},
      {"[camera]", "map_width = 1\nmap_center = [0, 0, 0]\nmap_far = 1\n[camera]", "lacks 'map_near'"},
      {"[camera]", "map_width = 1\nmap_center = [0, 0, 0]\nmap_near = 2\nmap_far = 2\n[camera]",
       "must lie beyond 'map_near', which is 2", "7"}};
  for (const char* value : {"[1, 2]", "\"big\""}) scenes.push_back({kSize, value, "3 numbers", "9"});
  for (const char* value : {"[1, 2, 0]", "[1, 2, -3]", "[1, 2, nan]", "[1, inf, 3]", "[1, \"two\", 3]"})
    scenes.push_back({kSize, value, "above 0", "9"});
  for (const auto& [lines, message] : std::initializer_list<std::pair<const char*, const char*>>{
           {"radius = 0.1", "'target'"},
           {"target = [0, 3, 0]", "it has no direction"},
           {"target = [0, 0, 0]\ncone_deg = 0", "'cone_deg'"},
           {"target = [0, 0, 0]\ncone_deg = 180", "'cone_deg'"},
           {"target = [0, 0, 0]\ncone_deg = 40\ninner_cone_deg = 41", "'inner_cone_deg'"},
           {"target = [0, 0, 0]\nradius = -1", "'radius'"},
           {"target = [0, 0, nan]", "'target'"},
           {"target = [0, 0, 0]\nsize = [1, 0]", "'size'"},
           {"target = [0, 0, 0]\nsize = [1, 1]\nradius = 1", "both a 'radius' and a 'size'"},
           {"target = [0, 0, 0]\nangular_diameter_deg = 1", "unknown key 'angular_diameter_deg'"},
           {"target = [0, 0, 0]\nmap_width = 3", "unknown key 'map_width'"}})
    scenes.push_back({kLight, std::string("type = 'spot'\nposition = [0, 3, 0]\n") + lines, message});
  for (const auto& [from, to, message, line] : scenes) {
    SCOPED_TRACE(to);
    const Complaint c = complaint_about(*from ? replaced(kBase, from, to) : kBase + to);
    EXPECT_THAT(c.message, HasSubstr(message));
    if (*line) EXPECT_EQ(c.line, line);
  }
  for (const auto& [text, message] : {std::pair(replaced(kBase, "[light]\ndirection = [0, -1, 0]\n", ""), "no [light]"),
                                      {"title = 't'\n[light]\ndirection = [0, -1, 0]\n", "empty"}})
    EXPECT_THAT(error_of([&, text = text] { load_text(text); }).message(), HasSubstr(message));
}

TEST(SceneFileTest, MapWindow_IsReadWithItsPlanes) {
  EXPECT_FALSE(load_text(kBase).light.map_window.has_value());
  const std::string light = "direction = [0, -1, 0]\nmap_center = [1, 2, 3]\nmap_width = 4\n";
  const auto free = load_text(replaced(kBase, "direction = [0, -1, 0]\n", light)).light.map_window;
  ASSERT_TRUE(free.has_value());
  EXPECT_EQ(free->center_ws, glm::dvec3(1, 2, 3));
  EXPECT_EQ(free->width_m, 4.0);
  EXPECT_FALSE(free->planes.has_value());
  const std::string planes = light + "map_near = -1.5\nmap_far = 2\n";
  const auto fixed = load_text(replaced(kBase, "direction = [0, -1, 0]\n", planes)).light.map_window;
  ASSERT_TRUE(fixed && fixed->planes);
  EXPECT_EQ(fixed->planes->near_m, -1.5);
  EXPECT_EQ(fixed->planes->far_m, 2.0);
}

TEST(SceneFileTest, Spot_HasAConeThatFacesItsTarget) {
  const auto spot = [](const std::string& lines) {
    return replaced(kBase, "direction = [0, -1, 0]", "type = \"spot\"\nposition = [0, 3, 0]\n" + lines);
  };
  const Scene scene = load_text(spot("target = [0, 1, 0]\ncone_deg = 40\nradius = 0.2"));
  const auto& light = std::get<Spot>(scene.light.kind);
  EXPECT_EQ(light.inner_cone_deg, 30.0f);
  EXPECT_EQ(light.radius_m, 0.2f);
  EXPECT_EQ(to_light(scene.light, {0.0f, 2.0f, 0.0f}), glm::vec3(0.0f, 1.0f, 0.0f));
  const Scene tube = load_text(spot("target = [0, 0, 0]\nsize = [2, 0.1]"));
  EXPECT_EQ(std::get<Spot>(tube.light.kind).size_m, glm::vec2(2.0f, 0.1f));
}

TEST(SceneFileTest, AzimuthAndElevation_SayWhereTheLightStands) {
  const Scene scene = load_text(replaced(kBase, "direction = [0, -1, 0]", "azimuth_deg = 90\nelevation_deg = 30"));
  EXPECT_NEAR(-to_light(scene.light, {}).x, -std::sqrt(0.75f), 1e-6f);
  EXPECT_NEAR(-to_light(scene.light, {}).y, -0.5f, 1e-6f);
  EXPECT_NEAR(-to_light(scene.light, {}).z, 0.0f, 1e-6f);
}

TEST(SceneFileTest, Rotation_TurnsAboutXFirstThenYThenZ) {
  const Scene scene = load_text(replaced(kBase, "center = [0, 1, 0]", "rotation_deg = [90, 90, 90]"));
  // x: (1, 2, 3) -> (1, 3, 2); then y: -> (2, 3, 1); then z: -> (3, 2, 1).
  const glm::vec3 size = scene.bounds().max - scene.bounds().min;
  EXPECT_NEAR(size.x, 3.0f, 1e-5f);
  EXPECT_NEAR(size.y, 2.0f, 1e-5f);
  EXPECT_NEAR(size.z, 1.0f, 1e-5f);
}

TEST(SceneFileTest, Scale_IsANumberOrThree) {
  EXPECT_FLOAT_EQ(load_text(std::string(kBase) + "scale = 2\n").bounds().max.z, 3.0f);
  EXPECT_FLOAT_EQ(load_text(std::string(kBase) + "scale = [1, 1, 4.0]\n").bounds().max.z, 6.0f);
}

TEST(SceneFileTest, EveryShape_Loads) {
  for (const std::string shape :
       {"shape = \"plane\"\nsize = [2, 2]", "shape = \"sphere\"\nradius = 1",
        "shape = \"cylinder\"\nradius = 1\nheight = 2",
        "shape = \"bars\"\ncount = 3\nbar_width = 0.1\nspacing = 0.5\nlength = 2\ndirection = \"both\""}) {
    const Scene scene = load_text(replaced(kBase, "shape = \"box\"\nsize = [1, 2, 3]", shape));
    EXPECT_GT(scene.triangle_count(), 0U) << shape;
    EXPECT_TRUE(scene.warnings.empty()) << shape;
  }
}

TEST(SceneFileTest, SeveralCameras_KeepTheirNamesAndOrder) {
  const std::string second = "[[camera]]\nname = \"b\"\nposition = [9, 9, 9]\ntarget = [0, 0, 0]\n";
  const Scene scene = load_text(replaced(kBase, "[camera]\n", second + "[[camera]]\nname = \"a\"\n"));
  ASSERT_EQ(scene.cameras.size(), 2U);
  EXPECT_EQ(scene.cameras[0].name, "b");
  EXPECT_EQ(scene.cameras[1].name, "a");
  EXPECT_THAT(complaint_about(replaced(kBase, "[camera]\n", second + "[[camera]]\nname = \"b\"\n")).message,
              HasSubstr("two cameras"));
}

TEST(SceneFileTest, OrthographicHeight_IsGivenInPlaceOfAFieldOfView) {
  const std::string height = "target = [0, 0, 0]\northographic_height = 3.5\n";
  const Scene scene = load_text(replaced(kBase, "target = [0, 0, 0]\n", height));
  EXPECT_EQ(scene.cameras[0].orthographic_height_m, 3.5f);
  const Complaint c = complaint_about(replaced(kBase, "target = [0, 0, 0]\n", height + "vertical_fov_deg = 40\n"));
  EXPECT_THAT(c.message, AllOf(HasSubstr("[camera]"), HasSubstr("give one")));
  EXPECT_EQ(c.line, "7");
}

TEST(SceneFileTest, NoCamera_IsFramed) {
  const Scene scene = load_text(replaced(kBase, "[camera]\nposition = [0, 2, 5]\ntarget = [0, 0, 0]\n", ""));
  EXPECT_EQ(scene.cameras.size(), 1U);
}

TEST(SceneFileTest, CastsShadowFalse_IsKept) {
  EXPECT_TRUE(load_text(kBase).meshes[0].casts_shadow);
  EXPECT_FALSE(load_text(std::string(kBase) + "casts_shadow = false\n").meshes[0].casts_shadow);
}

TEST(SceneFileTest, ModelObject_IsReadBesideTheSceneAndTakesTheGivenMaterial) {
  const TestFolder folder;
  folder.write("models/tri.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  const std::string object = "[[object]]\nshape = \"model\"\nfile = \"models/tri.obj\"\ncenter = [0, 5, 0]\n";
  const std::string red = "material = \"red\"\n[[material]]\nname = \"red\"\ncolor = [1, 0, 0]\n";
  const Scene own = load(folder.write("a.toml", kBase + red + object).string(), {});
  EXPECT_FLOAT_EQ(own.bounds().max.y, 6.0f);
  EXPECT_EQ(own.materials[static_cast<std::size_t>(own.meshes[1].material)].name, "default");
  const Scene given = load(folder.write("b.toml", kBase + object + red).string(), {});
  EXPECT_EQ(given.materials[static_cast<std::size_t>(given.meshes[1].material)].name, "red");
}

TEST(SceneFileTest, ModelOutsideTheScenesFolder_IsTheUsersChoice) {
  const TestFolder folder;
  const auto model = folder.write("models/tri.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  for (const std::string& file : {std::string("../models/tri.obj"), model.string()}) {
    const std::string object = "[[object]]\nshape = \"model\"\nfile = \"" + file + "\"\n";
    EXPECT_EQ(load(folder.write("scenes/a.toml", kBase + object).string(), {}).meshes.size(), 2U);
  }
}

TEST(SceneFileTest, ShapesBeyondAllMemory_AreRefusedBeforeTheyAreMade) {
  const std::string bars =
      "[[object]]\nshape = \"bars\"\ncount = 10000\nbar_width = 0.1\nspacing = 0.3\nlength = 2\ndirection = "
      "\"both\"\ncells = 512\n";
  const Complaint c = complaint_about(kBase + bars);
  EXPECT_THAT(c.message, AllOf(HasSubstr("10000 bars"), HasSubstr("'count' or 'cells'")));
  EXPECT_EQ(c.line, "14");
  std::string spheres;
  for (int i = 0; i < 9; ++i) spheres += "[[object]]\nshape = \"sphere\"\nradius = 1\nsegments = 1024\n";
  EXPECT_THAT(complaint_about(kBase + spheres).message, HasSubstr("more than 4194304 triangles"));
}

TEST(SceneFileTest, KeyOfManyDots_DoesNotExhaustTheStack) {
  std::string key = "a";
  for (int i = 0; i < 1'000'000; ++i) key += ".a";
  const Complaint c = complaint_about(kBase + key + " = 1\n");
  EXPECT_THAT(c.message, HasSubstr("256 dots"));
  EXPECT_EQ(c.line, "12");
}

/// Wherever a file may say it, what is no number is refused by the name of its key.
TEST(SceneFileTest, NotANumberOrInfinity_IsRefusedByItsKey) {
  for (const std::string key : {"direction", "position", "target", "size", "center", "rotation_deg", "scale"}) {
    for (const std::string number : {"nan", "inf", "-inf"}) {
      const std::string base(kBase), line = "\n" + key + " = [1, " + number + ", 1]\n";
      const std::size_t at = std::min(base.find("\n" + key + " "), base.size() - 1);
      const std::string text = base.substr(0, at) + line + base.substr(std::min(base.find('\n', at + 1), base.size()));
      EXPECT_THAT(complaint_about(text).message, AllOf(HasSubstr("'" + key + "'"), HasSubstr(number))) << key;
    }
  }
}

TEST(SceneFileTest, DenormalNumbers_BecomeAFiniteScene_OrAreRefused) {
  for (const std::string list : {"[0, -1, 0]", "[0, 2, 5]", "[0, 0, 0]", "[1, 2, 3]", "[0, 1, 0]"}) {
    try {
      const Scene scene = load_text(replaced(kBase, list, "[1e-40, -1e-40, 1e-40]"));
      for (const Vertex& v : scene.meshes.at(0).vertices) {
        EXPECT_TRUE(std::isfinite(glm::dot(v.position_ws, v.position_ws))) << list;
        EXPECT_NEAR(glm::length(v.normal_ws), 1.0f, 1e-3f) << list;
      }
      EXPECT_NEAR(glm::length(to_light(scene.light, {})), 1.0f, 1e-3f) << list;
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::kInput) << list;
    }
  }
}

TEST(SceneFileTest, ListsInMessages_AreShortAndOnOneLine) {
  const std::string many =
      replaced(kBase, "size = [1, 2, 3]",
               "size = [1, 2, inf, -inf, nan, 1e300, 7" + std::string(3000, ' ') + ", -9223372036854775808]");
  const Complaint c = complaint_about(many);
  EXPECT_THAT(c.message, HasSubstr("but is [1, 2, inf, -inf, nan, 1e+300, ...]"));
  EXPECT_THAT(c.message, Not(HasSubstr("\n")));
}

constexpr const char* kTwoLights = R"(
title = "two"
[[light]]
name = "sun"
azimuth_deg = 20
elevation_deg = 50
[[light]]
name = "lamp"
type = "point"
position = [0, 3, 0]
[[object]]
shape = "plane"
size = [4, 4]
)";

TEST(SceneFileTest, SeveralLights_AreSeparated_EachUnderItsName) {
  const Scene scene = load_text(kTwoLights);
  const std::vector<Scene> lit = separate_lights(scene);
  ASSERT_EQ(lit.size(), 2u);
  EXPECT_EQ(lit[0].name, scene.name + ".sun");
  EXPECT_EQ(lit[1].name, scene.name + ".lamp");
  EXPECT_TRUE(std::holds_alternative<Sun>(lit[0].light.kind));
  EXPECT_TRUE(std::holds_alternative<PointLight>(lit[1].light.kind));
  EXPECT_TRUE(lit[0].other_lights.empty() && lit[1].other_lights.empty());
}

TEST(SceneFileTest, ACameraForOneLight_IsSeenUnderThatAlone) {
  const std::string camera =
      "[[camera]]\nname = \"close\"\nlight = \"lamp\"\nposition = [0, 2, 5]\ntarget = [0, 0, 0]\n";
  const std::vector<Scene> lit = separate_lights(load_text(kTwoLights + camera));
  ASSERT_EQ(lit[0].cameras.size(), 1u);
  EXPECT_EQ(lit[0].cameras[0].name, "sun") << "chosen, for it has none";
  ASSERT_EQ(lit[1].cameras.size(), 1u);
  EXPECT_EQ(lit[1].cameras[0].name, "close");
  EXPECT_THAT(complaint_about(kTwoLights + replaced(camera, "light = \"lamp\"", "light = \"lump\"")).message,
              HasSubstr("there is no light 'lump'; did you mean 'lamp'?"));
}

TEST(SceneFileTest, SeveralLights_NeedNamesOfTheirOwn) {
  std::string text = kTwoLights;
  text.replace(text.find("\"lamp\""), 6, "\"sun\"");
  EXPECT_THAT(complaint_about(text).message, HasSubstr("two lights have the name 'sun'"));
  text = kTwoLights;
  text.erase(text.find("name = \"lamp\""), 13);
  EXPECT_THAT(complaint_about(text).message, HasSubstr("has no 'name': of several lights each needs one"));
}

TEST(SceneFileTest, Opacity_IsTheAlphaOfWhatBlends) {
  const auto text = [](const std::string& opacity) {
    return std::string(kBase) +
           "material = \"glass\"\n[[material]]\nname = \"glass\"\ncolor = [1, 0, 0]\nopacity = " + opacity;
  };
  const Material glass = load_text(text("0.3")).materials.front();
  EXPECT_EQ(glass.alpha_mode, AlphaMode::kBlend);
  EXPECT_EQ(glass.base_color, glm::vec4(1.0f, 0.0f, 0.0f, 0.3f));
  EXPECT_EQ(load_text(text("1")).materials.front().alpha_mode, AlphaMode::kOpaque);
  for (const char* bad : {"1.5", "-0.1", "nan", "inf"}) {
    const Complaint c = complaint_about(text(bad));
    EXPECT_THAT(c.message, AllOf(HasSubstr("'opacity'"), HasSubstr(bad)));
    EXPECT_EQ(c.line, "16");
  }
}

namespace fs = std::filesystem;

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
  Scene made = load(file.string(), {});
  const Scene plane = made;
  made.meshes = {make_floor(floor)};
  test::expect_same_geometry(made, plane);
}

TEST(SceneWriterTest, PathsHoldFromTheNewPlace_ThroughLinksToo) {
  const TestFolder folder;
  folder.write("models/tri.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  const fs::path source = folder.write("scenes/a.toml",
                                       "title = 'One \"quoted\" caf\u00e9'\nmodel = '../models/tri.obj'\n[light]\n"
                                       "type = 'spot'\nposition = [0, 3, 0]\ntarget = [0, 0, 0]\nsize = [0.3, 0.1]\n"
                                       "[[object]]\nshape = 'model'\n"
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
  EXPECT_THAT(error_of([&] { settle(camera); }), is_error(ErrorKind::kInput, "camera 'far'", "'vertical_fov_deg'"));
}

}  // namespace
}  // namespace shadowbench::scene
