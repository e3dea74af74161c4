#include "harness/flicker/motion.h"

#include <gmock/gmock.h>

#include <algorithm>

#include "base/error.h"
#include "harness/scene/load.h"

namespace shadowbench::flicker {
namespace {

using ::testing::Each;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

constexpr int kFrames = 8;

scene::Scene load_cubes() {
  scene::LoadOptions load;
  load.scenes_folder = std::string(SHADOWBENCH_SOURCE_DIR) + "/data/scenes";
  return scene::load("cubes", load);
}

/// Points on the floor of cubes, all seen by the camera.
truth::ReceiverImage make_floor() {
  truth::ReceiverImage image{5, 5, {}};
  for (int y = 0; y < 5; ++y) {
    for (int x = 0; x < 5; ++x)
      image.points.push_back({{-1.0f + 0.5f * static_cast<float>(x), 0.0f, -1.0f + 0.5f * static_cast<float>(y)},
                              {0.0f, 1.0f, 0.0f},
                              true});
  }
  return image;
}

std::vector<scene::LightFrustum> fit(Motion motion, bool snap, double step) {
  const scene::Scene scene = load_cubes();
  return fit_frames(motion, scene, make_frames(motion, scene, step, kFrames), {512, 5.0, 16.0 / 9.0, snap});
}

double step_of(Motion motion) { return choose_step(motion, load_cubes(), make_floor(), {512, 5.0, 16.0 / 9.0, false}); }

double grid_move(Motion motion, bool snap) {
  const truth::ReceiverImage floor = make_floor();
  const auto frusta = fit(motion, snap, step_of(motion));
  return measure_grid_move(floor, mark_receivers(floor, frusta, 512, 5.0), frusta, 512).value();
}

TEST(Motion, NamesAreReadOnceEach) {
  EXPECT_THAT(parse_motions("camera,light"), ElementsAre(Motion::kCamera, Motion::kLight));
  EXPECT_THAT(parse_motions("light"), ElementsAre(Motion::kLight));
  for (const char* bad : {"", "lights", "light,", "light,light"}) EXPECT_THROW(parse_motions(bad), Error) << bad;
}

TEST(Motion, FirstFrameIsTheScenes_AndOnlyOneThingMoves) {
  const scene::Scene scene = load_cubes();
  const auto turned = make_frames(Motion::kLight, scene, 0.01, 3), moved = make_frames(Motion::kCamera, scene, 0.5, 3);
  EXPECT_EQ(scene::to_light(turned[0].light, {}), scene::to_light(scene.light, {}));
  EXPECT_NEAR(glm::length(-scene::to_light(turned[2].light, {})), 1.0f, 1e-6f);
  EXPECT_EQ(scene::to_light(turned[2].light, {}).y, scene::to_light(scene.light, {}).y) << "about the vertical";
  EXPECT_EQ(turned[2].camera.position_ws, scene.cameras.front().position_ws);
  EXPECT_EQ(scene::to_light(moved[2].light, {}), scene::to_light(scene.light, {}));
  EXPECT_NEAR(glm::distance(moved[2].camera.position_ws, scene.cameras.front().position_ws), 1.0f, 1e-5f);
}

TEST(Motion, LightsStep_MovesTheMedianReceiverByTheShareOfATexel) {
  EXPECT_NEAR(grid_move(Motion::kLight, false), kStepTexels, 0.2 * kStepTexels);
}

TEST(Motion, SnappedGrid_StandsStillUnderACamera_AndAFreeOneDoesNot) {
  EXPECT_LT(grid_move(Motion::kCamera, true), 1e-6);
  EXPECT_GT(grid_move(Motion::kCamera, false), 0.01);
  EXPECT_EQ(count_resizes(fit(Motion::kCamera, true, step_of(Motion::kCamera))), 0);
}

TEST(Motion, ReceiversThatLeaveTheMapOrTurnAway_AreNotMarked) {
  truth::ReceiverImage floor = make_floor();
  const auto frusta = fit(Motion::kLight, false, 1e-3);
  EXPECT_THAT(mark_receivers(floor, frusta, 512, 5.0), Each(1));
  floor.points[0].position_ws.x = 50.0f;  // outside
  floor.points[1].normal_ws.y = -1.0f;    // turned away
  floor.points[2].counts = false;
  const auto marked = mark_receivers(floor, frusta, 512, 5.0);
  EXPECT_THAT(std::vector(marked.begin(), marked.begin() + 4), ElementsAre(0, 0, 0, 1));
}

TEST(Motion, LightOverhead_IsSaid) {
  scene::Scene scene = load_cubes();
  scene.light.kind = scene::Sun{{0.0f, -1.0f, 0.0f}};
  try {
    choose_step(Motion::kLight, scene, make_floor(), {512, 5.0, 16.0 / 9.0, false});
    FAIL() << "a step was found";
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), HasSubstr("overhead"));
  }
}

}  // namespace
}  // namespace shadowbench::flicker
