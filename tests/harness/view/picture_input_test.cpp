#include "harness/view/picture_input.h"

#include <gtest/gtest.h>

#include <cmath>

namespace shadowbench::view {
namespace {

scene::Camera make_camera() {
  scene::Camera camera;
  camera.position_ws = {3.0f, 2.0f, 5.0f};
  camera.forward_ws = glm::normalize(glm::vec3(-0.5f, -0.3f, -0.8f));
  return camera;
}

/// A point as the camera sees it: right, up, ahead.
glm::vec3 see(const scene::Camera& camera, const glm::vec3& point_ws) {
  const glm::vec3 right = glm::normalize(glm::cross(camera.forward_ws, camera.up_ws));
  const glm::vec3 way = point_ws - camera.position_ws;
  return {glm::dot(way, right), glm::dot(way, glm::cross(right, camera.forward_ws)), glm::dot(way, camera.forward_ws)};
}

TEST(Orbit, KeepsThePivotWhereItIsSeen_AndGoesToTheRight) {
  const glm::vec3 pivot(0.5f, 0.2f, -1.0f);
  const scene::Camera before = make_camera(), after = orbit(before, pivot, 0.4f, 0.2f);
  for (int axis = 0; axis < 3; ++axis) EXPECT_NEAR(see(before, pivot)[axis], see(after, pivot)[axis], 1e-5f);
  const glm::vec3 right = glm::normalize(glm::cross(before.forward_ws, before.up_ws));
  EXPECT_GT(glm::dot(after.position_ws - before.position_ws, right), 0.5f);
  EXPECT_GT(after.position_ws.y, before.position_ws.y);
  EXPECT_NEAR(glm::length(after.forward_ws), 1.0f, 1e-6f);
}

TEST(Orbit, ThereAndBack_IsWhereItWas) {
  const glm::vec3 pivot(0.5f, 0.2f, -1.0f);
  const scene::Camera before = make_camera(), after = orbit(orbit(before, pivot, 0.4f, 0.2f), pivot, -0.4f, -0.2f);
  for (int axis = 0; axis < 3; ++axis) EXPECT_NEAR(before.position_ws[axis], after.position_ws[axis], 1e-4f);
}

TEST(LookAround, StopsBeforeStraightDown_AndDoesNotMove) {
  const scene::Camera after = look_around(make_camera(), 0.3f, -9.0f);
  EXPECT_NEAR(after.forward_ws.y, -std::sin(glm::radians(89.0f)), 1e-5f);
  EXPECT_EQ(after.position_ws, make_camera().position_ws);
}

TEST(Fly, FollowsTheCamerasAxes) {
  const scene::Camera before = make_camera(), after = fly(before, {0.0f, 0.0f, 2.0f});
  for (int axis = 0; axis < 3; ++axis)
    EXPECT_NEAR(after.position_ws[axis], (before.position_ws + 2.0f * before.forward_ws)[axis], 1e-5f);
}

TEST(Approach, ScalesTheDistance_AndWhatAnOrthographicViewShows) {
  scene::Camera camera = make_camera();
  camera.orthographic_height_m = 4.0f;
  const glm::vec3 pivot(1.0f, 0.0f, 0.0f);
  const scene::Camera after = approach(camera, pivot, 0.5f);
  EXPECT_NEAR(glm::distance(after.position_ws, pivot), 0.5f * glm::distance(camera.position_ws, pivot), 1e-5f);
  EXPECT_FLOAT_EQ(after.orthographic_height_m, 2.0f);
}

TEST(Sky, ALightStandsWhereItIsPut_WhateverItsKind) {
  scene::Spot spot;
  spot.position_ws = {1.0f, 3.0f, 1.0f};
  for (const scene::LightKind& kind : {scene::LightKind(scene::Sun()), scene::LightKind(spot),
                                       scene::LightKind(scene::PointLight{{1.0f, 2.0f, 0.5f}, 0.1f, 1.0f})}) {
    scene::Light light;
    light.kind = kind;
    light = scene::place_in_sky(light, {120.0, 35.0});
    EXPECT_NEAR(find_in_sky(light).azimuth_deg, 120.0, 1e-3);
    EXPECT_NEAR(find_in_sky(light).elevation_deg, 35.0, 1e-3);
    const scene::SkyAngles moved = find_in_sky(move_in_sky(light, 10.0, 70.0));
    EXPECT_NEAR(moved.elevation_deg, 90.0, 0.05);  // no farther than straight above
  }
}

}  // namespace
}  // namespace shadowbench::view
