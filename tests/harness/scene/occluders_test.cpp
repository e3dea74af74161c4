// What rays hit of a scene: what casts a shadow, but for the holes of its material; and where kernels lie in a map.

#include <gtest/gtest.h>

#include <algorithm>

#include "harness/scene/lights/light_fit.h"
#include "harness/scene/scene.h"
#include "reference/truth/visibility.h"
#include "tests/harness/scene/gltf_parts.h"

namespace shadowbench::scene {
namespace {

/// A roof over the left half of a floor that is seen from above.
Scene make_roofed_scene() {
  Scene scene;
  scene.materials.emplace_back();
  Mesh roof;
  for (const glm::vec3 p : {glm::vec3(-2, 1, -2), glm::vec3(0, 1, -2), glm::vec3(-2, 1, 2), glm::vec3(0, 1, 2)})
    roof.vertices.push_back({p, {0.0f, 1.0f, 0.0f}, {0.5f * p.x, 0.5f * p.z}});
  roof.indices = {0, 1, 2, 2, 1, 3};
  scene.meshes = {roof};
  return scene;
}

truth::ReceiverImage make_receivers() {
  truth::ReceiverImage receivers{32, 1, {}};
  for (int i = 0; i < 32; ++i) {
    const float x = -1.0f + 2.0f * (static_cast<float>(i) + 0.5f) / 32.0f;
    receivers.points.push_back({{x, 0.0f, 0.0f}, {0.0f, 1.0f, 0.0f}, true});
  }
  return receivers;
}

std::vector<float> trace_hard(const Scene& scene) {
  return truth::trace_hard(truth::Occluders(list_occluders(scene)), make_receivers(), make_area_light(scene.light));
}

TEST(Occluders, MeshesThatCastNoShadow_BlockNothing) {
  Scene scene = make_roofed_scene();
  EXPECT_EQ(trace_hard(scene).front(), 0.0f);
  EXPECT_EQ(trace_hard(scene).back(), 1.0f);
  scene.meshes[0].casts_shadow = false;
  EXPECT_TRUE(list_occluders(scene).empty());
  EXPECT_EQ(trace_hard(scene), std::vector<float>(32, 1.0f));
}

TEST(Occluders, HolesOfAMaterial_LetRaysThrough) {
  Scene scene = make_roofed_scene();
  scene.materials[0].alpha_mode = AlphaMode::kMask;
  scene.materials[0].base_color.a = 0.2f;
  EXPECT_EQ(trace_hard(scene), std::vector<float>(32, 1.0f));
  scene.materials[0].alpha_cutoff = 0.1f;
  EXPECT_EQ(trace_hard(scene).front(), 0.0f);
  // u runs from -1 to 0 under the roof, and from -0.5 above the receivers: the texture's second texel, then its first.
  scene.materials[0].alpha_cutoff = 0.5f;
  scene.materials[0].base_color.a = 1.0f;
  scene.materials[0].base_color_texture = 0;
  scene.textures.push_back(
      {"striped", 4, 1, {255, 255, 255, 255, 255, 255, 255, 255, 255, 255, 255, 0, 255, 255, 255, 255}});
  const std::vector<float> hard = trace_hard(scene);
  EXPECT_NEAR(static_cast<double>(std::count(hard.begin(), hard.begin() + 16, 1.0f)), 8.0, 2.0)
      << "the transparent texel";
  EXPECT_EQ(hard[15], 0.0f) << "an opaque one";
}

TEST(Occluders, AMaterialThatBlends_DimsRays) {
  Scene scene = make_roofed_scene();
  scene.materials[0].alpha_mode = AlphaMode::kBlend;
  scene.materials[0].base_color.a = 0.2f;
  EXPECT_NEAR(trace_hard(scene).front(), 0.8f, 1e-6f);
  EXPECT_EQ(trace_hard(scene).back(), 1.0f);
  scene.materials[0].base_color_texture = 0;
  scene.textures.push_back({"half", 1, 1, {255, 255, 255, 51}});
  EXPECT_NEAR(trace_hard(scene).front(), 1.0f - 0.2f * 0.2f, 1e-6f);
}

/// Whether light falls through a roof over the receivers' left and right half. The roof is a picture whose right half
/// is a hole, under a KHR_texture_transform.
std::pair<bool, bool> lit_halves(const std::string& transform) {
  scene::GltfParts parts = scene::textured_parts(R"({"bufferView": 3, "mimeType": "image/png"})");
  parts.nodes = R"([{"mesh": 0, "translation": [-1, 1, 1], "scale": [2, 2, 2],
      "rotation": [-0.70710678118654752, 0, 0, 0.70710678118654752]}])";
  parts.more = fmt::format(R"(, "images": [{{"bufferView": 3, "mimeType": "image/png"}}], "textures": [{{"source": 0}}],
      "materials": [{{"alphaMode": "MASK", "alphaCutoff": 0.75, "pbrMetallicRoughness": {{"baseColorTexture":
      {{"index": 0, "extensions": {{"KHR_texture_transform": {}}}}}}}}}])",
                           transform);
  const std::vector<float> hard = trace_hard(scene::add_mesh_file({}, scene::import_parts(parts)));
  const auto lit = [&](std::ptrdiff_t first) { return std::count(&hard[0] + first, &hard[0] + first + 16, 1.0f); };
  EXPECT_EQ(lit(0) + lit(16), 16) << "half of them";
  return {lit(0) == 16, lit(16) == 16};
}

TEST(Occluders, HoleOfATransformedTexture_IsWhereTheTransformPutsIt) {
  EXPECT_EQ(lit_halves("{}"), std::pair(false, true));
  EXPECT_EQ(lit_halves(R"({"offset": [0.5, 0]})"), std::pair(true, false));
  EXPECT_EQ(lit_halves(R"({"scale": [-1, 1]})"), std::pair(true, false));
  EXPECT_EQ(lit_halves(R"({"rotation": 3.14159265358979})"), std::pair(true, false));
}

TEST(MapGrid, IsThatOfTheLightsMap) {
  Scene scene = make_roofed_scene();
  scene.light.kind = Sun{glm::normalize(glm::vec3(-0.5f, -1.0f, -0.25f))};
  const LightFrustum frustum = fit_light(scene, FitMode::kTight, 64, 2.0);
  const truth::MapGrid grid = make_map_grid(frustum);
  const auto texel_of = [&](const glm::dvec3& p) {
    return 64.0 * glm::dvec3(glm::dmat4(frustum.uv_depth_from_world) * glm::dvec4(p, 1.0));
  };
  const glm::dvec3 start = texel_of(glm::dvec3(0.0));
  const glm::dvec3 right = texel_of(grid.texel_size_ws * grid.right) - start;
  const glm::dvec3 up = texel_of(grid.texel_size_ws * grid.up) - start;
  const glm::dvec3 towards = texel_of(grid.to_light) - start;
  EXPECT_LT(glm::distance(right, glm::dvec3(1.0, 0.0, 0.0)), 1e-4);
  EXPECT_LT(glm::distance(up, glm::dvec3(0.0, 1.0, 0.0)), 1e-4);
  EXPECT_LT(glm::length(glm::dvec2(towards)), 1e-4);
  EXPECT_LT(towards.z, 0.0);
}

}  // namespace
}  // namespace shadowbench::scene
