#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

#include "harness/scene/complete.h"
#include "harness/scene/load.h"
#include "harness/scene/mesh_tools.h"
#include "tests/test_files.h"

namespace shadowbench::scene {
namespace {

// The edges of shadows in coarse views: whose they are, and how a view is scored.

/// A square sheet high over the middle of a floor. The camera looks straight down; the sun stands so low that the
/// sheet's shadow lies beside it.
Scene make_sheet_over_floor() {
  Scene scene;
  scene.materials.resize(2);
  scene.meshes = {
      make_plane({8.0f, 8.0f}, 1),
      transform_mesh(make_plane({1.0f, 1.0f}, 1), glm::translate(glm::dmat4(1.0), glm::dvec3(-2.0, 2.0, 0.0)))};
  scene.meshes[1].material = 1;
  Camera camera;
  camera.position_ws = {0.0f, 10.0f, 0.0f};
  camera.forward_ws = {0.0f, -1.0f, 0.0f};
  camera.up_ws = {0.0f, 0.0f, -1.0f};
  camera.orthographic_height_m = 6.0f;
  scene.cameras = {camera};
  scene.light = place_in_sky({}, {-90.0, 40.0});
  return scene;
}

EdgeCount count(const Scene& scene) { return EdgeMeter(scene).count(scene.cameras[0], scene.light, 1.0); }

TEST(EdgeMeter, CountsThePixelsAlongAShadowsEdge) {
  // 96 pixels to 6 m: the outline of a shadow of 1 m x 1 m is 64 pixels long, and has a pixel on either side. Its four
  // corner pixels touch an edge twice.
  const EdgeCount edges = count(make_sheet_over_floor());
  EXPECT_EQ(edges.pixels, 96 * 96);
  EXPECT_EQ(edges.surfaces, 96 * 96);
  EXPECT_NEAR(edges.at_edge, 2 * 64 - 4, 8);
}

TEST(EdgeMeter, PenumbraeFollowFromTheLightsSizeAndTheOccludersDistance) {
  Scene scene = make_sheet_over_floor();
  const auto list = [&] { return EdgeMeter(scene).list_penumbrae(scene.cameras[0], scene.light, 1.0); };
  // The sheet hangs 2 m over the floor: along the light's way it is that over the sine of 40 degrees away.
  const double behind = 2.0 / std::sin(glm::radians(40.0));
  const auto of_sun = list();
  EXPECT_GT(of_sun.size(), 100u);
  for (const EdgePenumbra& each : of_sun) EXPECT_NEAR(each.width_ws, light_size(scene.light) * behind, 1e-4);
  // A lamp 6 m over the floor: by similar triangles half as wide as the lamp.
  PointLight lamp;
  lamp.position_ws = {-2.0f, 6.0f, 0.0f};
  lamp.radius_m = 0.1f;
  scene.light.kind = lamp;
  const auto of_lamp = list();
  EXPECT_GT(of_lamp.size(), 20u);
  for (const EdgePenumbra& each : of_lamp) EXPECT_NEAR(each.width_ws, 0.1, 1e-3);
  scene.meshes.pop_back();
  EXPECT_TRUE(list().empty());
}

TEST(EdgeMeter, PerspectiveAndOrthographicCamerasSeeTheSameEdges) {
  Scene scene = make_sheet_over_floor();
  scene.meshes[1] = transform_mesh(scene.meshes[1], glm::translate(glm::dmat4(1.0), glm::dvec3(0.0, -1.5, 0.0)));
  const int flat = count(scene).at_edge;
  scene.cameras[0].position_ws.y = 1000.0f;
  scene.cameras[0].orthographic_height_m = 0.0f;
  scene.cameras[0].vertical_fov_rad = 2.0f * std::atan(0.003f);
  EXPECT_GT(flat, 40);
  EXPECT_NEAR(count(scene).at_edge, flat, 12);
}

TEST(EdgeMeter, SilhouettesAreNoEdgesOfShadows) {
  Scene scene = make_sheet_over_floor();
  // 0.3 m high, the sheet leaves 0.36 m of its shadow to be seen. Where the lit sheet hides the rest is no edge.
  scene.meshes[1] = transform_mesh(scene.meshes[1], glm::translate(glm::dmat4(1.0), glm::dvec3(0.0, -1.7, 0.0)));
  EXPECT_NEAR(count(scene).at_edge, 2 * 16 * (0.36 + 1.0 + 0.36) - 2, 6);
}

TEST(EdgeMeter, FloorThatIsWoundTheOtherWay_IsTheSame) {
  Scene scene = make_sheet_over_floor();
  const EdgeCount edges = count(scene);
  std::swap_ranges(scene.meshes[0].indices.begin(), scene.meshes[0].indices.begin() + 1,
                   scene.meshes[0].indices.begin() + 1);
  std::swap_ranges(scene.meshes[0].indices.begin() + 3, scene.meshes[0].indices.begin() + 4,
                   scene.meshes[0].indices.begin() + 4);
  EXPECT_EQ(count(scene).at_edge, edges.at_edge);
}

TEST(EdgeMeter, SphereAlone_HasNone) {
  Scene scene = make_sheet_over_floor();
  scene.meshes = {make_sphere(2.5f, 96)};
  EXPECT_GT(count(scene).surfaces, 1000);
  EXPECT_EQ(count(scene).at_edge, 0) << "where it turns away from the light";
}

TEST(EdgeMeter, CameraFartherThanRaysReach_SeesNothing) {
  Scene scene = make_sheet_over_floor();
  scene.cameras[0].orthographic_height_m = 1e30f;
  EXPECT_EQ(count(scene).surfaces, 0);
  scene.cameras[0].orthographic_height_m = 0.0f;
  scene.cameras[0].position_ws.x = 1e30f;
  EXPECT_EQ(count(scene).surfaces, 0);
}

TEST(EdgeMeter, WhatCastsNoShadow_IsStillSeenAndShadowed) {
  Scene scene = make_sheet_over_floor();
  const EdgeCount all = count(scene);
  scene.meshes[0].casts_shadow = false;
  EXPECT_EQ(count(scene).at_edge, all.at_edge);
  EXPECT_EQ(count(scene).surfaces, all.surfaces);
  scene.meshes[1].casts_shadow = false;
  EXPECT_EQ(count(scene).at_edge, 0);
  EXPECT_EQ(count(scene).surfaces, all.surfaces);
}

TEST(EdgeMeter, HolesOfAMaterialLetTheLightThrough) {
  Scene scene = make_sheet_over_floor();
  scene.materials[1].alpha_mode = AlphaMode::kMask;
  scene.materials[1].base_color.a = 0.2f;
  EXPECT_EQ(count(scene).at_edge, 0);
}

TEST(EdgeMeter, SidesThatFaceAwayFromTheLight_AreSurfacesWithoutEdges) {
  Scene scene = make_sheet_over_floor();
  scene.light = place_in_sky({}, {-90.0, -40.0});
  EXPECT_EQ(count(scene).at_edge, 0);
  EXPECT_EQ(count(scene).surfaces, 96 * 96);
}

TEST(EdgeMeter, OutsideTheConeOfASpot_NothingIsCounted) {
  Scene scene = make_sheet_over_floor();
  scene.light.kind = Spot{.position_ws = {-6.0f, 6.0f, 0.0f}, .target_ws = {2.0f, 0.0f, 0.0f}};
  EXPECT_GT(count(scene).at_edge, 0);
  scene.light.kind = Spot{.position_ws = {-6.0f, 6.0f, 0.0f}, .target_ws = {-6.0f, 0.0f, 0.0f}, .cone_deg = 10.0f};
  EXPECT_EQ(count(scene).at_edge, 0);
}

TEST(EdgeMeter, FloorIsSeenAndShadowed_AndCanBeTakenAway) {
  Scene scene = make_sheet_over_floor();
  const EdgeCount on_mesh = count(scene);
  const Mesh floor = scene.meshes[0];
  scene.meshes.erase(scene.meshes.begin());
  EdgeMeter meter(scene);
  meter.set_floor(&floor);
  EXPECT_EQ(meter.count(scene.cameras[0], scene.light, 1.0).at_edge, on_mesh.at_edge);
  meter.set_floor(nullptr);
  EXPECT_EQ(meter.count(scene.cameras[0], scene.light, 1.0).at_edge, 0);
}

TEST(EdgeCount, ViewThatShowsLittle_DoesNotWinByAFewPixels) {
  EXPECT_DOUBLE_EQ((EdgeCount{1000, 800, 80}.share()), 0.1);
  EXPECT_DOUBLE_EQ((EdgeCount{1000, 100, 50}.share()), 0.1);
  EXPECT_DOUBLE_EQ((EdgeCount{1000, 0, 0}.share()), 0.0);
  EXPECT_DOUBLE_EQ((EdgeCount{}.share()), 0.0);
}

/// Whether a lamp of this place is seen over a box on a floor, and a sun.
std::vector<bool> list_seen(const std::string& place, const std::string& camera = {}) {
  const TestFolder folder;
  std::vector<bool> seen;
  const auto file = folder.write("a.toml", "title = \"a\"\n" + camera +
                                               "[[light]]\nname = \"sun\"\nazimuth_deg = 60\nelevation_deg = 40\n"
                                               "[[light]]\nname = \"lamp\"\ntype = \"point\"\nposition = " +
                                               place +
                                               "\n[[object]]\nshape = \"plane\"\nsize = [12, 12]\n"
                                               "[[object]]\nshape = \"box\"\nsize = [2, 2, 2]\ncenter = [0, 1, 0]\n");
  for (const Scene& lit : separate_lights(load_scene(file)))
    seen.push_back(is_light_in_view(lit, lit.cameras, 16.0 / 9.0));
  return seen;
}

TEST(LightInView, IsTheOneThatReachesASurface) {
  using testing::ElementsAre;
  EXPECT_THAT(list_seen("[0, 1.5, 0]"), ElementsAre(true, false)) << "in the box";
  EXPECT_THAT(list_seen("[2, 3, 0]"), ElementsAre(true, true));
  EXPECT_THAT(list_seen("[2, 3, 0]", "[camera]\nposition = [0, 5, 0]\ntarget = [0, 9, 0.1]\n"),
              ElementsAre(false, false));
  EXPECT_THAT(list_seen("[2, 3, 0]", "[camera]\nposition = [0, 3000, 1]\ntarget = [0, 0, 0]\n"),
              ElementsAre(true, true))
      << "a few pixels";
}

}  // namespace
}  // namespace shadowbench::scene
