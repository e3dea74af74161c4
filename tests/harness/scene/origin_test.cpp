#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>

#include "harness/scene/load.h"
#include "harness/scene/scene_writer.h"
#include "tests/harness/scene/gltf_parts.h"

// A scene far from its origin: every stage sees it as if it were near.

namespace shadowbench::scene {
namespace {

/// A floor and a model, under a lamp, moved along x and z.
std::string toml_at(double distance) {
  const auto at = [&](double x, double y, double z) {
    return fmt::format("[{:.12g}, {}, {:.12g}]\n", distance + x, y, distance + z);
  };
  return "title = \"far\"\n[camera]\nposition = " + at(3.1, 2.5, 4.3) + "target = " + at(0.3, 0.5, 0.2) +
         "[[light]]\nname = \"lamp\"\ntype = \"spot\"\nposition = " + at(1.3, 3.7, 0.1) +
         "target = " + at(0.1, 0.0, 0.7) +
         "[[light]]\nname = \"sun\"\nazimuth_deg = 40\nelevation_deg = 50\nmap_center = " + at(0.1, 0.0, 0.3) +
         "map_width = 3\n[[object]]\nshape = \"plane\"\nsize = [8.2, 8.2]\ncenter = " + at(0.1, 0.1, 0.3) +
         "[[object]]\nshape = \"model\"\nfile = \"far.obj\"\nscale = 2\nrotation_deg = [0, 90, 0]\n";
}

/// A square whose place is in its vertices.
std::string obj_at(double x, double z) {
  return fmt::format("v {0} 0 {1}\nv {2} 0 {1}\nv {2} 1.1 {1}\nv {0} 1.1 {1}\nf 1 2 3 4\n", x, z, x + 1.3);
}

struct Place {
  const char* what;
  std::function<Scene(double distance)> load_at;
};

std::vector<Place> list_places() {
  return {{"a scene file",
           [](double d) {
             const TestFolder folder;
             // Turned by a quarter and doubled, the square stands at twice (z, -x).
             folder.write("far.obj", obj_at(-0.5 * d, 0.5 * d));
             return load(folder.write("far.toml", toml_at(d)).string(), {});
           }},
          {"an OBJ file",
           [](double d) {
             const TestFolder folder;
             return load(folder.write("far.obj", obj_at(d, d)).string(), {});
           }},
          {"a glTF file",
           [](double d) {
             const TestFolder folder;
             GltfParts parts;
             parts.nodes = fmt::format(R"([{{"mesh": 0, "translation": [{0}, 0.3, {0}]}},
                 {{"extensions": {{"KHR_lights_punctual": {{"light": 0}}}}, "translation": [{0}, 5, {0}]}},
                 {{"camera": 0, "translation": [{1}, 2, {1}]}}])",
                                       d, d + 3.1);
             parts.scenes = R"([{"nodes": [0, 1, 2]}])";
             parts.more = R"(, "extensionsUsed": ["KHR_lights_punctual"], "extensions": {"KHR_lights_punctual":
                 {"lights": [{"type": "point"}]}}, "cameras": [{"type": "perspective", "perspective": {"yfov": 0.5, "znear": 0.1}}])";
             folder.write("data.bin", parts.buffer);
             return load(folder.write("far.gltf", gltf_of(parts)).string(), {});
           }}};
}

/// A scene's places as its file has them.
std::vector<glm::dvec3> list_places_of(const Scene& scene) {
  std::vector<glm::dvec3> all;
  for (const Mesh& mesh : scene.meshes)
    for (const Vertex& v : mesh.vertices) all.emplace_back(v.position_ws);
  for (const Camera& camera : scene.cameras) all.emplace_back(camera.position_ws);
  for (const Scene& lit : separate_lights(scene)) {
    if (const auto beam = find_beam(lit.light)) all.push_back(beam->position_ws);
    if (lit.light.map_window) all.push_back(lit.light.map_window->center_ws);
  }
  for (glm::dvec3& place : all) place += scene.origin_ws;
  return all;
}

double largest_of(const Scene& scene) {
  const Bounds bounds = scene.bounds();
  const glm::vec3 most = glm::max(glm::abs(bounds.min), glm::abs(bounds.max));
  return static_cast<double>(std::max({most.x, most.y, most.z}));
}

TEST(SceneOrigin, FarScenes_KeepEveryDigitOfTheirFile) {
  for (const Place& place : list_places()) {
    SCOPED_TRACE(place.what);
    const Scene near = place.load_at(0.0);
    EXPECT_EQ(near.origin_ws, glm::dvec3(0.0));
    const std::vector<glm::dvec3> expected = list_places_of(near);
    for (const double distance : {100.0, 200.0, 500.0, 10e3, 1e6, 1e9}) {
      SCOPED_TRACE(distance);
      const Scene far = place.load_at(distance);
      EXPECT_LT(largest_of(far), 16.0);
      EXPECT_THAT(far.warnings, testing::ElementsAreArray(near.warnings));
      const std::vector<glm::dvec3> places = list_places_of(far);
      ASSERT_EQ(places.size(), expected.size());
      const double rounding = 2e-6 + 4e-16 * distance;
      for (std::size_t i = 0; i < places.size(); ++i)
        EXPECT_LT(glm::distance(places[i] - glm::dvec3(distance, 0.0, distance), expected[i]), rounding) << i;
    }
  }
}

TEST(SceneOrigin, WhatIsSaved_IsReadBack) {
  const TestFolder folder;
  folder.write("far.obj", obj_at(-5e3, 5e3));
  const auto file = folder.write("far.toml", toml_at(10e3));
  const Scene scene = load(file.string(), {});
  const Scene read =
      load(folder
               .write("saved.toml", write_scene({file, &scene, scene.cameras, {scene.light, scene.other_lights.at(0)}},
                                                folder.path() / "saved.toml"))
               .string(),
           {});
  EXPECT_EQ(read.origin_ws, scene.origin_ws);
  EXPECT_EQ(list_places_of(read), list_places_of(scene));
}

TEST(SceneOrigin, PositionsThatTheirFileHasRounded_AreAWarning) {
  const auto load_at = [](float distance) {
    const TestFolder folder;
    GltfParts parts;
    std::vector<float> quad = kQuad;
    for (float& number : quad) number += distance;
    parts.buffer = bytes_of(quad) + bytes_of(kQuadIndices);
    folder.write("data.bin", parts.buffer);
    return load(folder.write("baked.gltf", gltf_of(parts)).string(), LoadOptions{{}, true}).warnings;
  };
  EXPECT_THAT(load_at(0.0f), testing::IsEmpty());
  EXPECT_THAT(load_at(100.0f), testing::IsEmpty());
  EXPECT_THAT(load_at(10e3f), testing::ElementsAre(testing::HasSubstr("rounds positions in its file to 0.0012 m")));
}

}  // namespace
}  // namespace shadowbench::scene
