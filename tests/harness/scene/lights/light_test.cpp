#include "harness/scene/lights/light.h"

#include <gtest/gtest.h>

#include "harness/scene/complete.h"
#include "harness/scene/lights/light_fit.h"
#include "harness/scene/load.h"

namespace shadowbench::scene {
namespace {

Light make_light(double azimuth_deg, double elevation_deg) {
  Light light;
  light.kind = Sun{glm::vec3(light_direction(azimuth_deg, elevation_deg)), 2.0f};
  light.intensity = 3.0f;
  return light;
}

TEST(Light, TurnedAboutTheVertical_IsAsHigh) {
  for (const int degrees : {0, 23, 120, 240}) {
    const Light light = turn_about_vertical(make_light(72.0, 38.0), glm::radians(static_cast<double>(degrees)));
    EXPECT_LT(glm::length(to_light(light, {}) - to_light(make_light(72.0 + degrees, 38.0), {})), 1e-6f) << degrees;
    EXPECT_EQ(light.intensity, 3.0f);
    EXPECT_EQ(light_size(light), light_size(make_light(72.0, 38.0)));
  }
}

TEST(LightFit, OfAnotherLight_EqualsTheFitOfASceneWithThatLight) {
  Scene scene;
  scene.meshes.push_back({"m", {{{-1, 0, -2}}, {{3, 0, 1}}, {{0, 2, 0}}}, {0, 1, 2}});
  scene.light = make_light(10.0, 50.0);
  Scene other = scene;
  other.light = make_light(200.0, 20.0);
  const LightFrustum fit = fit_light(scene, FitRequest{.map_size = 64, .light = &other.light});
  EXPECT_EQ(fit.uv_depth_from_world, fit_light(other, FitRequest{.map_size = 64}).uv_depth_from_world);
  EXPECT_EQ(fit.direction_ws, fit_light(other, FitRequest{.map_size = 64}).direction_ws);
  EXPECT_NE(fit.uv_depth_from_world, fit_light(scene, FitRequest{.map_size = 64}).uv_depth_from_world);
  other.light.map_window = MapWindow{{0.5, 0.0, 0.0}, 3.0, MapWindow::Planes{-2.0, 4.0}};
  EXPECT_EQ(fit_light(scene, FitRequest{.map_size = 64, .light = &other.light}).width_ws, 3.0);
}

}  // namespace
}  // namespace shadowbench::scene
