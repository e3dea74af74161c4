#include "harness/scene/validate.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "harness/scene/primitives.h"
#include "test_files.h"

namespace shadowbench::scene {
namespace {

using testing::HasSubstr;

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinity = std::numeric_limits<float>::infinity();

Scene make_scene() {
  Scene scene;
  scene.meshes.push_back(make_plane({2.0f, 2.0f}, 2));
  scene.meshes.back().name = "floor";
  scene.materials.push_back({.name = "grey"});
  scene.cameras.emplace_back();
  return scene;
}

std::string message_of(const Scene& scene) {
  const Error error = error_of([&] { validate(scene, "file.toml"); });
  EXPECT_EQ(error.kind(), ErrorKind::kInput);
  EXPECT_EQ(error.where(), "file.toml");
  return error.message();
}

TEST(ValidateTest, SoundScene_PassesUnchanged) {
  const Scene scene = validate(make_scene(), "file.toml");
  EXPECT_EQ(scene.triangle_count(), 8U);
  EXPECT_TRUE(scene.warnings.empty());
}

TEST(ValidateTest, PositionNotFinite_NamesMeshAndVertex) {
  for (const float bad : {kNaN, kInfinity, -kInfinity, 1e30f}) {
    Scene scene = make_scene();
    scene.meshes[0].vertices[3].position_ws.y = bad;
    EXPECT_THAT(message_of(scene), AllOf(HasSubstr("vertex 3"), HasSubstr("'floor'")));
  }
}

TEST(ValidateTest, NormalOrTextureCoordinateNotFinite_NamesMeshAndVertex) {
  Scene scene = make_scene();
  scene.meshes[0].vertices[2].normal_ws.x = kNaN;
  EXPECT_THAT(message_of(scene), AllOf(HasSubstr("vertex 2"), HasSubstr("normal")));
  scene = make_scene();
  scene.meshes[0].vertices[1].uv.x = kInfinity;
  EXPECT_THAT(message_of(scene), AllOf(HasSubstr("vertex 1"), HasSubstr("texture coordinate")));
}

TEST(ValidateTest, AlphaThatCannotBlend_IsNamed) {
  for (const float bad : {1.5f, -0.25f, kNaN, kInfinity}) {
    Scene scene = make_scene();
    scene.materials[0].base_color.a = bad;
    if (std::isfinite(bad)) EXPECT_NO_THROW(validate(scene, "file.toml")) << "an opaque material's says nothing";
    scene.materials[0].alpha_mode = AlphaMode::kBlend;
    EXPECT_THAT(message_of(scene), AllOf(HasSubstr("'grey'"), HasSubstr(fmt::format("{}", bad)), HasSubstr("0 and 1")));
  }
}

TEST(ValidateTest, IndexOutOfRange_IsAnError) {
  Scene scene = make_scene();
  scene.meshes[0].indices[5] = 9;
  EXPECT_THAT(message_of(scene), AllOf(HasSubstr("index 5"), HasSubstr("9 vertices")));
}

TEST(ValidateTest, MaterialOrTextureOutOfRange_IsAnError) {
  Scene scene = make_scene();
  scene.meshes[0].material = 1;
  EXPECT_THAT(message_of(scene), HasSubstr("material 1 of 1"));
  scene = make_scene();
  scene.materials[0].base_color_texture = 0;
  EXPECT_THAT(message_of(scene), HasSubstr("texture 0 of 0"));
}

TEST(ValidateTest, EmptyScene_IsAnError) {
  Scene scene = make_scene();
  scene.meshes.clear();
  EXPECT_THAT(message_of(scene), HasSubstr("empty"));
}

TEST(ValidateTest, TrianglesWithoutArea_AreDroppedCountedAndTold) {
  Scene scene = make_scene();
  scene.meshes[0].indices.insert(scene.meshes[0].indices.end(), {0, 0, 1, 0, 1, 2});
  const Scene valid = validate(scene, "file.toml");
  EXPECT_EQ(valid.triangle_count(), 8U);
  EXPECT_THAT(valid.warnings, testing::ElementsAre(HasSubstr("2 of 10 triangles")));
}

TEST(ValidateTest, TinyButSoundTriangles_AreKept) {
  Scene scene = make_scene();
  for (Vertex& vertex : scene.meshes[0].vertices) vertex.position_ws *= 1e-12f;
  EXPECT_EQ(validate(scene, "file.toml").triangle_count(), 8U);
}

TEST(ValidateTest, OnlyTrianglesWithoutArea_IsAnError) {
  Scene scene = make_scene();
  scene.meshes[0].indices = {0, 0, 1};
  EXPECT_THAT(message_of(scene), HasSubstr("none of its 1 triangles has an area"));
}

TEST(ValidateTest, VerticesThatNoTriangleUses_DoNotWidenTheBounds) {
  Scene scene = make_scene();
  scene.meshes[0].vertices.push_back({glm::vec3(500.0f), {0, 1, 0}, {}});
  EXPECT_FLOAT_EQ(validate(scene, "file.toml").bounds().max.x, 1.0f);
}

TEST(ValidateTest, NormalsOfAnyLength_BecomeUnitLength) {
  Scene scene = make_scene();
  scene.meshes[0].vertices[0].normal_ws = {0.0f, 5.0f, 0.0f};
  scene.meshes[0].vertices[1].normal_ws = glm::vec3(0.0f);
  const Scene valid = validate(scene, "file.toml");
  for (const Vertex& v : valid.meshes[0].vertices) EXPECT_EQ(v.normal_ws, glm::vec3(0, 1, 0));
}

TEST(ValidateTest, LightWithoutDirection_IsAnError) {
  Scene scene = make_scene();
  scene.light.kind = Sun{glm::vec3(0.0f)};
  EXPECT_THAT(message_of(scene), HasSubstr("light has no direction"));
  scene.light.kind = Sun{{0.0f, kNaN, 0.0f}};
  EXPECT_THAT(message_of(scene), HasSubstr("light has no direction"));
}

TEST(ValidateTest, LightDirection_BecomesUnitLength) {
  Scene scene = make_scene();
  scene.light.kind = Sun{{0.0f, -8.0f, 0.0f}};
  EXPECT_EQ(-to_light(validate(scene, "file.toml").light, {}), glm::vec3(0, -1, 0));
}

TEST(ValidateTest, NegativeOrInfiniteLight_IsAnError) {
  Scene scene = make_scene();
  scene.light.intensity = -1.0f;
  EXPECT_THAT(message_of(scene), HasSubstr("intensity"));
  scene.light.intensity = 1.0f;
  scene.light.color.x = kInfinity;
  EXPECT_THAT(message_of(scene), HasSubstr("colour"));
  scene.light.color.x = 1.0f;
  std::get<Sun>(scene.light.kind).angular_diameter_deg = kNaN;
  EXPECT_THAT(message_of(scene), HasSubstr("angular diameter"));
}

TEST(ValidateTest, CameraWithoutDirectionOrView_IsAnError) {
  Scene scene = make_scene();
  scene.cameras[0].forward_ws = glm::vec3(0.0f);
  EXPECT_THAT(message_of(scene), HasSubstr("camera 'main' has no direction"));
  scene = make_scene();
  scene.cameras[0].vertical_fov_rad = 4.0f;
  EXPECT_THAT(message_of(scene), HasSubstr("field of view"));
  scene = make_scene();
  scene.cameras[0].position_ws.z = kNaN;
  EXPECT_THAT(message_of(scene), HasSubstr("stands at"));
}

TEST(ValidateTest, CameraUpAlongItsView_IsReplacedByAnAxisAcrossIt) {
  for (const glm::vec3& forward : {glm::vec3(0, -1, 0), glm::vec3(0, 1, 0), glm::vec3(0, -3, 0)}) {
    Scene scene = make_scene();
    scene.cameras[0].forward_ws = forward;
    const Camera camera = validate(scene, "file.toml").cameras[0];
    EXPECT_NEAR(glm::length(camera.up_ws), 1.0f, 1e-6f);
    EXPECT_NEAR(glm::dot(camera.up_ws, camera.forward_ws), 0.0f, 1e-6f);
  }
}

TEST(ValidateTest, CamerasOfEqualName_AreToldApart) {
  Scene scene = make_scene();
  scene.cameras.resize(3);
  const Scene valid = validate(scene, "file.toml");
  EXPECT_EQ(valid.cameras[1].name, "main 2");
  EXPECT_EQ(valid.cameras[2].name, "main 3");
}

}  // namespace
}  // namespace shadowbench::scene
