// What decides whether a view is traced again: geometry, receivers, light, kernel, texel size and seed; nothing else.

#include "harness/measure/scene_tracer.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <functional>

namespace shadowbench::measure {
namespace {

/// A roof over the left half of a floor that is seen from above.
scene::Scene make_scene() {
  scene::Scene scene;
  scene.materials.emplace_back();
  scene::Mesh roof;
  for (const glm::vec3 p : {glm::vec3(-2, 1, -2), glm::vec3(0, 1, -2), glm::vec3(-2, 1, 2), glm::vec3(0, 1, 2)})
    roof.vertices.push_back({p, {0.0f, 1.0f, 0.0f}, {0.5f * p.x, 0.5f * p.z}});
  roof.indices = {0, 1, 2, 2, 1, 3};
  scene.meshes = {roof};
  scene.light.direction_ws = {0.0f, -1.0f, 0.0f};
  scene.light.angular_diameter_deg = 2.0f;
  return scene;
}

ViewReceivers make_receivers() {
  ViewReceivers receivers{{32, 4, {}}, std::vector<std::uint8_t>(128, 1), "receivers"};
  for (int i = 0; i < 128; ++i) {
    receivers.image.points.push_back(
        {{-1.0f + 2.0f * (static_cast<float>(i % 32) + 0.5f) / 32.0f, 0.0f, 0.1f * static_cast<float>(i / 32)},
         {0.0f, 1.0f, 0.0f},
         true});
  }
  return receivers;
}

scene::LightFrustum make_frustum() {
  scene::LightFrustum frustum;
  frustum.light_from_world = glm::dmat4(1.0);
  frustum.light_from_world[1] = {0.0, 0.0, 1.0, 0.0};
  frustum.light_from_world[2] = {0.0, -1.0, 0.0, 0.0};
  frustum.direction_ws = {0.0f, -1.0f, 0.0f};
  frustum.texel_size_ws = 0.05;
  return frustum;
}

class Tracer : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = std::filesystem::temp_directory_path() / ("shadowbench.tracer." + std::to_string(getpid()));
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  /// Says how many images were traced, the others being in the cache.
  int count_traced(const scene::Scene& scene, const std::function<void(SceneTracer&)>& work, std::uint32_t seed = 1) {
    TruthCache cache(folder_, [](const std::string& message) { FAIL() << message; });
    SceneTracer tracer(scene, cache, seed);
    work(tracer);
    return cache.traced();
  }

  std::filesystem::path folder_;
};

TEST_F(Tracer, ASecondRun_DoesNotTraceAgain_AndSeesTheSame) {
  ViewRays first, second;
  EXPECT_EQ(count_traced(
                make_scene(), [&](SceneTracer& t) { first = t.trace_view(make_receivers()); }),
            1);
  EXPECT_EQ(count_traced(make_scene(), [&](SceneTracer& t) { second = t.trace_view(make_receivers()); }), 0);
  EXPECT_EQ(first.area.visibility, second.area.visibility);
  EXPECT_EQ(first.area.standard_error, second.area.standard_error);
  EXPECT_EQ(first.area.unanimous, second.area.unanimous);
  EXPECT_EQ(first.area.rays, second.area.rays);
  EXPECT_EQ(first.hard, second.hard);
  EXPECT_EQ(first.first_blockers_ws, second.first_blockers_ws);
  EXPECT_EQ(first.hard.front(), 0.0f);
  EXPECT_EQ(first.hard.back(), 1.0f);
  EXPECT_NEAR(first.first_blockers_ws.front(), 1.0f, 1e-5f);
}

TEST_F(Tracer, WhatTheTruthFollowsFrom_TracesAgain) {
  const auto view = [](SceneTracer& t) { t.trace_view(make_receivers()); };
  ASSERT_EQ(count_traced(make_scene(), view), 1);
  scene::Scene changed = make_scene();
  changed.meshes[0].vertices[3].position_ws.y = std::nextafter(1.0f, 2.0f);
  EXPECT_EQ(count_traced(changed, view), 1) << "a vertex moved by one step";
  changed = make_scene();
  changed.meshes[0].indices = {0, 1, 2};
  EXPECT_EQ(count_traced(changed, view), 1) << "a triangle less";
  changed = make_scene();
  changed.light.angular_diameter_deg = 2.1f;
  EXPECT_EQ(count_traced(changed, view), 1) << "a wider light";
  changed = make_scene();
  changed.materials[0].alpha_mode = scene::AlphaMode::kMask;
  EXPECT_EQ(count_traced(changed, view), 1) << "holes";
  changed.materials[0].alpha_cutoff = 0.25f;
  EXPECT_EQ(count_traced(changed, view), 1) << "other holes";
  changed.materials[0].base_color_texture = 0;
  changed.textures.push_back({"holes", 2, 1, {255, 255, 255, 255, 255, 255, 255, 0}});
  EXPECT_EQ(count_traced(changed, view), 1) << "a texture";
  changed.textures[0].rgba[7] = 1;
  EXPECT_EQ(count_traced(changed, view), 1) << "another alpha";
  changed.meshes[0].vertices[3].uv.x += 0.25f;
  EXPECT_EQ(count_traced(changed, view), 1) << "the texture elsewhere";
  changed = make_scene();
  changed.meshes[0].casts_shadow = false;
  EXPECT_EQ(count_traced(changed, view), 1) << "no caster";
  ViewReceivers other = make_receivers();
  other.content = "other receivers";
  EXPECT_EQ(count_traced(make_scene(), [&](SceneTracer& t) { t.trace_view(other); }), 1);
  EXPECT_EQ(count_traced(make_scene(), view, 2), 1) << "another seed";
}

TEST_F(Tracer, WhatTheTruthDoesNotFollowFrom_DoesNot) {
  const auto view = [](SceneTracer& t) { t.trace_view(make_receivers()); };
  ASSERT_EQ(count_traced(make_scene(), view), 1);
  scene::Scene changed = make_scene();
  changed.name = "renamed";
  changed.materials[0].base_color.r = 0.1f;
  changed.light.intensity = 3.0f;
  EXPECT_EQ(count_traced(changed, view), 0);
}

TEST_F(Tracer, Kernels_AreKeptByKernelAndTexelSize) {
  using filters::Kernel;
  scene::LightFrustum coarse = make_frustum();
  coarse.texel_size_ws = 0.1;
  const auto trace_all = [&](SceneTracer& t) {
    const Kernel tent = Kernel::make_point(filters::Reconstruction::kBilinear);
    t.trace_kernel(make_receivers(), tent, make_frustum());
    t.trace_kernel(make_receivers(), tent, coarse);
    t.trace_kernel(make_receivers(), Kernel::make_disk(3.0), make_frustum());
    t.trace_surroundings(make_receivers(), 4.0, make_frustum());
  };
  EXPECT_EQ(count_traced(make_scene(), trace_all), 4);
  EXPECT_EQ(count_traced(make_scene(), trace_all), 0);
}

TEST_F(Tracer, MeshesThatCastNoShadow_BlockNothing) {
  scene::Scene scene = make_scene();
  scene.meshes[0].casts_shadow = false;
  EXPECT_EQ(make_occluders(scene).triangle_count(), 0);
  ViewRays rays;
  count_traced(scene, [&](SceneTracer& t) { rays = t.trace_view(make_receivers()); });
  for (const float v : rays.hard) EXPECT_EQ(v, 1.0f);
}

TEST_F(Tracer, Kernels_LieInTheMapsGrid) {
  // A slanted light whose map is turned about it.
  const glm::dvec3 to_light = glm::normalize(glm::dvec3(0.5, 1.0, 0.25));
  const glm::dvec3 right = glm::normalize(glm::cross(to_light, glm::dvec3(1.0, 0.1, 0.7))),
                   up = glm::cross(to_light, right);
  scene::LightFrustum frustum = make_frustum();
  frustum.direction_ws = -to_light;
  for (int i = 0; i < 3; ++i) frustum.light_from_world[i] = {right[i], up[i], to_light[i], 0.0};
  const auto kernel = filters::Kernel::make_grid({{-2.0, 0.5}, {2.0, 0.5}}, filters::Reconstruction::kNearest);
  const truth::MapGrid grid = {-glm::dvec3(frustum.direction_ws), right, up, frustum.texel_size_ws};
  const ViewReceivers receivers = make_receivers();
  truth::TracedVisibility traced, turned;
  EXPECT_EQ(count_traced(make_scene(),
                         [&](SceneTracer& t) {
                           traced = t.trace_kernel(receivers, kernel, frustum);
                           for (int i = 0; i < 3; ++i)
                             frustum.light_from_world[i] = {up[i], -right[i], to_light[i], 0.0};
                           turned = t.trace_kernel(receivers, kernel, frustum);
                         }),
            2)
      << "a map turned about the light is another map";
  EXPECT_EQ(traced.visibility,
            truth::trace_kernel(make_occluders(make_scene()), receivers.image, kernel, grid, {.seed = 1}).visibility);
  EXPECT_NE(traced.visibility, std::vector<float>(traced.visibility.size(), 1.0f));
}

TEST_F(Tracer, HolesOfAMaterial_LetRaysThrough) {
  scene::Scene scene = make_scene();
  scene.materials[0].alpha_mode = scene::AlphaMode::kMask;
  scene.materials[0].base_color.a = 0.2f;
  ViewRays rays;
  count_traced(scene, [&](SceneTracer& t) { rays = t.trace_view(make_receivers()); });
  for (const float v : rays.hard) EXPECT_EQ(v, 1.0f);
  // u runs from -1 to 0 under the roof, and from -0.5 above the receivers: the texture's second texel, then its first.
  scene.materials[0].base_color.a = 1.0f;
  scene.materials[0].base_color_texture = 0;
  scene.textures.push_back(
      {"striped", 4, 1, {255, 255, 255, 255, 255, 255, 255, 255, 255, 255, 255, 0, 255, 255, 255, 255}});
  count_traced(scene, [&](SceneTracer& t) { rays = t.trace_view(make_receivers()); });
  EXPECT_NEAR(static_cast<double>(std::count(rays.hard.begin(), rays.hard.begin() + 16, 1.0f)), 8.0, 2.0)
      << "the transparent texel";
  EXPECT_EQ(rays.hard[15], 0.0f) << "an opaque one";
}

}  // namespace
}  // namespace shadowbench::measure
