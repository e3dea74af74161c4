#include "harness/measure/light_width.h"

#include <gtest/gtest.h>

#include <glm/gtc/matrix_transform.hpp>

#include "harness/scene/mesh_tools.h"

namespace shadowbench::measure {
namespace {

/// A floor of 8 m with a sheet that hangs over it, seen from above under a sun of 2 degrees.
scene::Scene make_scene() {
  scene::Scene scene;
  scene.materials.resize(1);
  scene.meshes = {scene::make_plane({8.0f, 8.0f}, 1),
                  scene::transform_mesh(scene::make_plane({1.0f, 1.0f}, 1),
                                        glm::translate(glm::dmat4(1.0), glm::dvec3(-2.0, 2.0, 0.0)))};
  scene::Camera camera;
  camera.position_ws = {0.0f, 10.0f, 0.0f};
  camera.forward_ws = {0.0f, -1.0f, 0.0f};
  camera.up_ws = {0.0f, 0.0f, -1.0f};
  camera.orthographic_height_m = 6.0f;
  scene.cameras = {camera};
  scene::Sun sun;
  sun.angular_diameter_deg = 2.0f;
  scene.light.kind = sun;
  scene.light = scene::place_in_sky(scene.light, {-90.0, 40.0});
  return scene;
}

double find(const scene::Scene& scene, int map_size) {
  options::RunOptions options;
  options.width = options.height = 96;
  const scene::EdgeMeter meter(scene);
  return find_light_sigma(meter, options, {scene, scene.light, scene.cameras.front(), map_size, 4.0}).value_or(-1.0);
}

TEST(LightSigma, IsAQuarterOfThePenumbraInTexels) {
  const scene::Scene scene = make_scene();
  const double width_m = 2.0 * std::tan(glm::radians(1.0)) * 2.0 / std::sin(glm::radians(40.0));
  const double texel_m = scene::fit_light(scene, scene::FitMode::kTight, 1024, 4.0).texel_size_ws;
  EXPECT_NEAR(find(scene, 1024), 0.25 * width_m / texel_m, 0.006);
  EXPECT_NEAR(find(scene, 2048) / find(scene, 1024), 2.0, 0.02);
}

TEST(LightSigma, WithoutAShadow_IsAbsent) {
  scene::Scene scene = make_scene();
  scene.meshes.pop_back();
  EXPECT_EQ(find(scene, 1024), -1.0);
}

}  // namespace
}  // namespace shadowbench::measure
