#include "harness/scene/lights/point.h"

#include <gtest/gtest.h>

#include <set>

#include "harness/scene/lights/light_fit.h"
#include "harness/scene/load.h"
#include "tests/harness/scene/test_files.h"

namespace shadowbench::scene {
namespace {

Scene load_lantern() {
  return load("lantern", {.scenes_folder = std::filesystem::path(SHADOWBENCH_SOURCE_DIR) / "data" / "scenes"});
}

/// The face that a direction belongs to: its longest axis, x before y before z.
int face_of(const glm::dvec3& way) {
  int axis = 0;
  for (int i = 1; i < 3; ++i)
    if (std::abs(way[i]) > std::abs(way[axis])) axis = i;
  return 2 * axis + (way[axis] < 0.0 ? 1 : 0);
}

TEST(PointLight, ItsSixFacesHoldEverythingAround_WithTheirPadding) {
  const Scene scene = load_lantern();
  const auto faces = fit_layers(scene, {.map_size = 256, .pad_texels = 5.0});
  ASSERT_EQ(faces.size(), 6u);
  const glm::dvec3 light(std::get<PointLight>(scene.light.kind).position_ws);
  std::set<int> met;
  for (const Mesh& mesh : scene.meshes) {
    for (const Vertex& vertex : mesh.vertices) {
      const glm::dvec3 p(vertex.position_ws);
      const int face = face_of(p - light);
      met.insert(face);
      const glm::dvec3 place = faces[static_cast<std::size_t>(face)].place(p, 256);
      for (int axis = 0; axis < 2; ++axis) {
        EXPECT_GE(place[axis], 5.0 - 1e-3);
        EXPECT_LE(place[axis], 251.0 + 1e-3);
      }
      EXPECT_GT(place.z, 0.0);
      EXPECT_LT(place.z, 1.0);
    }
  }
  EXPECT_EQ(met.size(), 6u) << "the scene stands all around its light";
  for (const LightFrustum& face : faces) {
    EXPECT_EQ(face.depth_range_ws, faces.front().depth_range_ws) << "one curve stores the depth of all";
    EXPECT_EQ(face.texel_size_ws, faces.front().texel_size_ws);
  }
}

TEST(PointLight, ShinesAllAround_AndFallsOffWithTheSquareOfItsDistance) {
  const Scene scene = load_lantern();
  for (const glm::vec3 p : {glm::vec3(0.1f, 3.0f, 0.05f), glm::vec3(-2.0f, 0.0f, 1.0f), glm::vec3(2.0f, 1.3f, -4.0f)})
    EXPECT_TRUE(shines_on(scene.light, p));
  EXPECT_EQ(light_size(scene.light), 2.0 * static_cast<double>(std::get<PointLight>(scene.light.kind).radius_m));
}

/// A sphere's rays leave every receiver around its own way to the centre; a disk's only where it faces the receiver.
TEST(PointLight, IsTracedAsASphere_FromEverySide) {
  Light light;
  light.kind = PointLight{.position_ws = {1.0f, 2.0f, 3.0f}, .radius_m = 0.25f};
  const truth::AreaLight area = make_area_light(light);
  for (int face = 0; face < kCubeFaces; ++face) {
    glm::dvec3 from(1.0, 2.0, 3.0);
    from[face / 2] += face % 2 == 0 ? 4.0 : -4.0;
    const truth::AreaLight::Aim aim = area.aim(from);
    const glm::dvec3 way = area.centre_direction(from);
    EXPECT_NEAR(glm::length(way), 4.0, 1e-6);
    for (const glm::dvec3& half : {aim.u, aim.v}) {
      EXPECT_NEAR(glm::dot(half, way), 0.0, 1e-9) << face;
      EXPECT_NEAR(glm::length(half), 0.25, 1e-3) << face;
    }
  }
}

TEST(PointLight, GoesRoundTheOrigin) {
  Light light;
  light.kind = PointLight{.position_ws = {3.0f, 4.0f, 0.0f}};
  const Light quarter = turn_about_vertical(light, glm::radians(90.0));
  EXPECT_NEAR(glm::distance(std::get<PointLight>(quarter.kind).position_ws, glm::vec3(0.0f, 4.0f, -3.0f)), 0.0f, 1e-5f);
  const auto high = std::get<PointLight>(place_in_sky(light, {90.0, 90.0}).kind);
  EXPECT_NEAR(glm::distance(high.position_ws, glm::vec3(0.0f, 5.0f, 0.0f)), 0.0f, 1e-5f);
}

}  // namespace
}  // namespace shadowbench::scene
