#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <tuple>

#include "harness/options/options.h"
#include "harness/scene/complete.h"
#include "harness/scene/load.h"
#include "harness/tune/tune_scene.h"

namespace shadowbench::tune {
namespace {

scene::Scene load_scene(const std::string& name) {
  return scene::load(name, {.scenes_folder = options::find_resources().scenes});
}

void expect_near(const glm::vec3& a, const glm::vec3& b, float tolerance = 1e-5f) {
  EXPECT_LT(glm::length(a - b), tolerance);
}

TEST(TuneViews, UnseenOnes_AreNoneOfTheTrainingOnes) {
  std::set<std::tuple<double, double>> views;
  int training = 0;
  bool other_light = false;
  for (const TuneView& view : tune_views()) {
    EXPECT_TRUE(views.emplace(view.camera_turn_deg, view.light_turn_deg).second) << view.name();
    training += view.training ? 1 : 0;
    other_light = other_light || (!view.training && view.light_turn_deg != 0.0);
  }
  EXPECT_GE(training, 3);
  EXPECT_GT(static_cast<int>(views.size()), training);
  EXPECT_TRUE(other_light);
}

TEST(TuneViews, Words_NameEveryView) {
  EXPECT_EQ(describe_tune_views(true), "camera -20, as it is, camera +20");
  EXPECT_EQ(describe_tune_views(false), "camera -30, camera -10, camera +10, camera +30, light -15, light +15");
}

TEST(TurnCamera, KeepsHeightAndDistance_AndStillLooksAtThePivot) {
  for (const char* name : {"cubes", "stack", "fence", "ball", "steps"}) {
    SCOPED_TRACE(name);
    const scene::Scene scene = load_scene(name);
    const scene::Camera& camera = scene.cameras.front();
    const glm::vec3 pivot = find_pivot(scene, camera);
    const float distance = glm::length(pivot - camera.position_ws);
    expect_near(camera.position_ws + distance * camera.forward_ws, pivot, 1e-4f);
    for (const double degrees : {-30.0, 20.0, 90.0}) {
      const scene::Camera turned = turn_camera(camera, pivot, degrees);
      EXPECT_FLOAT_EQ(turned.position_ws.y, camera.position_ws.y);
      expect_near(turned.position_ws + distance * turned.forward_ws, pivot, 1e-4f);
      EXPECT_NEAR(glm::dot(turned.forward_ws, turned.up_ws), glm::dot(camera.forward_ws, camera.up_ws), 1e-5f);
    }
  }
}

TEST(TurnCamera, TurnsAsAnAzimuthGrows) {
  scene::Camera camera;
  camera.position_ws = {0.0f, 2.0f, 5.0f};
  camera.forward_ws = {0.0f, 0.0f, -1.0f};
  const scene::Camera turned = turn_camera(camera, {0.0f, 1.0f, 0.0f}, 90.0);
  expect_near(turned.position_ws, {5.0f, 2.0f, 0.0f});
  expect_near(turned.forward_ws, {-1.0f, 0.0f, 0.0f});
}

TEST(FindPivot, WithTheSceneBehindTheCamera_IsItsMiddle) {
  scene::Scene scene = load_scene("cubes");
  scene::Camera camera = scene.cameras.front();
  camera.forward_ws = -camera.forward_ws;
  const scene::Bounds bounds = scene.bounds();
  expect_near(find_pivot(scene, camera), 0.5f * (bounds.min + bounds.max));
}

TEST(FindPivot, OfACameraWithinTheScene_IsItsOwnPlace) {
  const scene::Scene scene = load_scene("avenue");
  const scene::Camera& camera = scene.cameras.front();
  expect_near(find_pivot(scene, camera), camera.position_ws);
}

TEST(MakeTuneScene, TurnsTheLightInAzimuth_AndNamesItsCameras) {
  scene::Scene scene = load_scene("cubes");
  scene.light.kind = scene::Sun{glm::vec3(scene::light_direction(70.0, 40.0))};
  const scene::Scene turned = turn_scene(scene, {{10.0, 15.0, false}, {0.0, 15.0, false}});
  expect_near(-scene::to_light(turned.light, {}), glm::vec3(scene::light_direction(85.0, 40.0)));
  ASSERT_EQ(turned.cameras.size(), 2u);
  EXPECT_EQ(turned.cameras[0].name, "camera +10 light +15");
  expect_near(turned.cameras[1].position_ws, scene.cameras.front().position_ws);
  EXPECT_EQ(turned.meshes.size(), scene.meshes.size());
}

/// The view as it is, is the scene's own to the bit: its truth is that of 'run'.
TEST(MakeTuneScene, WithoutATurn_ChangesNothing) {
  const scene::Scene scene = load_scene("fence");
  const scene::Scene same = turn_scene(scene, {{0.0, 0.0, true}});
  EXPECT_EQ(same.cameras.front().position_ws, scene.cameras.front().position_ws);
  EXPECT_EQ(same.cameras.front().forward_ws, scene.cameras.front().forward_ws);
  EXPECT_EQ(scene::to_light(same.light, {}), scene::to_light(scene.light, {}));
}

}  // namespace
}  // namespace shadowbench::tune
