#include "harness/scene/complete.h"

#include "harness/scene/load.h"
#include "tests/harness/scene/made_scenes.h"
#include "tests/test_files.h"

namespace shadowbench::scene {
namespace {

// Camera and sun of a scene that has none: chosen by the edges of shadows, and never in place of what was given.

constexpr ViewFreedom kAllFree{.camera = true, .sun = true};

/// A wall that faces the usual camera, which stands on its side in shadow, and a box behind it.
Scene make_wall() {
  return make_scene_of({move_mesh(make_box({8.0f, 4.0f, 0.2f}, 1), {0.0, 2.0, 0.0}),
                        move_mesh(make_box({1.0f, 1.0f, 1.0f}, 1), {0.0, 2.0, -1.5})});
}

Scene make_box_on_floor() {
  return make_scene_of({make_plane({6.0f, 6.0f}, 1), move_mesh(make_box({1.0f, 1.0f, 1.0f}, 1), {0.0, 0.5, 0.0})});
}

Camera make_own_camera() {
  Camera camera = make_camera({1.0f, 6.0f, -7.0f}, {-1.0f, -6.0f, 7.0f});
  camera.name = "own";
  return camera;
}

double turn_between(const SkyAngles& a, const SkyAngles& b) {
  return std::abs(std::remainder(a.azimuth_deg - b.azimuth_deg, 360.0));
}

Mesh make_triangle() {
  Mesh triangle;
  triangle.vertices = {{{0.0f, 1.0f, 0.0f}}, {{1.0f, 1.0f, 0.0f}}, {{0.0f, 1.0f, 1.0f}}};
  triangle.indices = {0, 2, 1};
  return triangle;
}

TEST(ViewChoice, WallWithABoxBehind_IsSeenFromWhereTheSunIs) {
  const ViewChoice choice = choose_view(make_wall(), kAllFree);
  EXPECT_FALSE(choice.is_usual);
  EXPECT_GT(choice.edges.share(), 0.02);
  EXPECT_GT(choice.edges.share(), 4.0 * choice.usual_edges.share());
  EXPECT_LT(std::cos(glm::radians(choice.angles.camera.azimuth_deg)), 0.0) << "the camera stands behind the wall";
}

TEST(ViewChoice, ChosenSun_ShinesOnSidesThatAreSeen) {
  for (const Scene& scene : {make_wall(), make_box_on_floor()}) {
    const ViewChoice choice = choose_view(scene, kAllFree);
    EXPECT_LT(turn_between(choice.angles.camera, choice.angles.sun), 115.0);
    EXPECT_GE(choice.edges.share(), choice.usual_edges.share());
  }
}

/// A floor with a row of boxes on either side.
Scene make_street(float length_m) {
  std::vector<Mesh> meshes = {make_plane({8.0f, length_m}, 1)};
  for (double z = 2.0 - 0.5 * static_cast<double>(length_m); z < 0.5 * static_cast<double>(length_m); z += 5.0)
    for (const double x : {-3.0, 3.0}) meshes.push_back(move_mesh(make_box({1.0f, 6.0f, 1.0f}, 1), {x, 3.0, z}));
  return make_scene_of(meshes);
}

TEST(Completion, CameraOfAStreet_StandsInItAtEyeHeight_AndLooksAlongIt) {
  const Scene street = complete(make_street(80.0f), {.needs_sun = true}, "x");
  const Camera& camera = street.cameras.at(0);
  EXPECT_NEAR(camera.position_ws.y, 1.5, 1e-3) << "a quarter of its height";
  EXPECT_LT(std::abs(camera.position_ws.x), 2.5f) << "between the boxes";
  EXPECT_LT(std::abs(camera.position_ws.z), 40.0f);
  EXPECT_GT(std::abs(camera.forward_ws.z), 0.99f);
  EXPECT_LT(camera.position_ws.z * camera.forward_ws.z, -30.0f) << "from one end to the other";
  EXPECT_THAT(street.notes, Contains(HasSubstr("at eye height")));
  const Scene square = complete(make_street(20.0f), {.needs_sun = true}, "x");
  EXPECT_GT(square.cameras.at(0).position_ws.y, 6.0f) << "no longer than wide and high";
}

TEST(Completion, WithAFloorUnderAPartAlone_TheCameraStaysOutside) {
  Scene row = make_street(80.0f);
  row.meshes.front() = make_plane({8.0f, 30.0f}, 1);
  EXPECT_GT(complete(row, {.needs_sun = true}, "x").cameras.at(0).position_ws.y, 6.0f);
}

TEST(ViewChoice, LongWallWithBoxesBefore_IsSeenFromAnEnd_UnlessItIsHigh) {
  const auto choose = [](float height_m) {
    std::vector<Mesh> meshes = {make_box({20.0f, height_m, 0.2f}, 1)};
    for (int i = -4; i <= 4; ++i) meshes.push_back(move_mesh(make_box({0.8f, 0.8f, 0.8f}, 1), {2.0 * i, 0.5 * i, 1.0}));
    return choose_view(make_scene_of(meshes), kAllFree);
  };
  EXPECT_LT(std::abs(std::sin(glm::radians(choose(8.0f).angles.camera.azimuth_deg))), 0.8);
  const ViewChoice choice = choose(6.0f);
  EXPECT_GT(choice.edges.share(), 0.0);
  EXPECT_GT(std::abs(std::sin(glm::radians(choice.angles.camera.azimuth_deg))), 0.8);
}

TEST(Completion, ChosenDirectionsDoNotDependOnTheSizeOfThePicture) {
  const Scene wide = complete(make_wall(), {.needs_sun = true, .aspect = 3.0}, "x");
  const Scene tall = complete(make_wall(), {.needs_sun = true, .aspect = 0.5}, "x");
  EXPECT_EQ(wide.cameras[0].forward_ws, tall.cameras[0].forward_ws);
  EXPECT_NE(wide.cameras[0].position_ws, tall.cameras[0].position_ws);
  EXPECT_EQ(to_light(wide.light, {}), to_light(tall.light, {}));
}

TEST(Completion, CameraOfItsOwn_StaysAndOnlyTheSunIsChosen) {
  Scene own = make_wall();
  own.cameras = {make_own_camera()};
  const Scene scene = complete(own, {.needs_sun = true}, "x");
  ASSERT_EQ(scene.cameras.size(), 1U);
  EXPECT_EQ(scene.cameras[0].name, "own");
  EXPECT_EQ(scene.cameras[0].position_ws, own.cameras[0].position_ws);
  EXPECT_EQ(scene.cameras[0].forward_ws, own.cameras[0].forward_ws);
  EXPECT_THAT(scene.notes, ElementsAre(AllOf(HasSubstr("sun from"), Not(HasSubstr("camera")))));
  EXPECT_NE(to_light(scene.light, {}), to_light(place_in_sky({}, usual_view(own.bounds()).sun), {}));
}

TEST(Completion, LightOfItsOwn_StaysAndOnlyTheCameraIsChosen) {
  Scene own = make_wall();
  own.light = place_in_sky({}, {190.0, 40.0});
  const Scene scene = complete(own, {}, "x");
  EXPECT_EQ(to_light(scene.light, {}), to_light(own.light, {}));
  EXPECT_LT(glm::dot(scene.cameras[0].forward_ws, to_light(own.light, {})), 0.0f);
  EXPECT_THAT(scene.notes, ElementsAre(AllOf(HasSubstr("camera from"), Not(HasSubstr("sun")))));
}

TEST(Completion, PlaceThatWasAskedFor_IsWhereTheSunStands) {
  for (const bool needs_sun : {true, false}) {
    const SkyAngles asked{190.0, 40.0};
    const Scene scene = complete(make_wall(), {.needs_sun = needs_sun, .ground = true, .light = asked}, "x");
    EXPECT_EQ(to_light(scene.light, {}), to_light(place_in_sky({}, asked), {}));
    EXPECT_THAT(scene.notes, ElementsAre(Not(HasSubstr("sun"))));
    Bounds floor;
    for (const Vertex& vertex : scene.meshes.back().vertices) floor.add(vertex.position_ws);
    const glm::vec3 way = to_light(scene.light, {});
    for (const Vertex& vertex : scene.meshes.front().vertices) {
      const glm::vec3 shadow = vertex.position_ws - way * ((vertex.position_ws.y - floor.min.y) / way.y);
      EXPECT_TRUE(shadow.x > floor.min.x && shadow.x < floor.max.x && shadow.z > floor.min.z && shadow.z < floor.max.z);
    }
  }
}

TEST(Completion, NothingIsChosenWhereNothingLacks) {
  Scene own = make_wall();
  own.cameras = {make_own_camera()};
  const Scene scene = complete(own, {}, "x");
  EXPECT_EQ(scene.cameras[0].position_ws, own.cameras[0].position_ws);
  EXPECT_EQ(to_light(scene.light, {}), to_light(own.light, {}));
  EXPECT_THAT(scene.notes, IsEmpty());
  EXPECT_THAT(scene.warnings, IsEmpty());
}

TEST(Completion, NoEdgeAnywhere_IsTheUsualViewAndAWarning) {
  const std::vector<Mesh> shadowless = {make_triangle(), make_plane({2.0f, 2.0f}, 4), make_box({1.0f, 1.0f, 1.0f}, 2),
                                        make_sphere(1.0f, 24)};
  for (const Mesh& mesh : shadowless) {
    const Scene bare = make_scene_of({mesh});
    const Scene scene = complete(bare, {.needs_sun = true}, "x");
    const ViewAngles usual = usual_view(bare.bounds());
    EXPECT_EQ(to_light(scene.light, {}), to_light(place_in_sky({}, usual.sun), {}));
    EXPECT_EQ(scene.cameras[0].forward_ws, frame_camera(scene, usual.camera, 16.0 / 9.0, {}).forward_ws);
    EXPECT_THAT(scene.notes, IsEmpty());
    EXPECT_THAT(scene.warnings, ElementsAre(AllOf(HasSubstr("the usual view"), HasSubstr("--ground"))));
  }
}

TEST(Completion, MoreThanAMillionTriangles_GetTheUsualView) {
  const Scene scene = complete(make_scene_of({make_plane({2.0f, 2.0f}, 730)}), {.needs_sun = true}, "x");
  EXPECT_THAT(scene.warnings, IsEmpty());
  EXPECT_THAT(scene.notes, ElementsAre(AllOf(HasSubstr("azimuth 30, elevation 24"), HasSubstr("1048576 triangles"))));
}

TEST(Completion, FloorUnderATriangle_ShowsItsShadow) {
  const Scene scene = complete(make_scene_of({make_triangle()}), {.needs_sun = true, .ground = true}, "x");
  EXPECT_THAT(scene.warnings, IsEmpty());
  EXPECT_THAT(scene.notes, ElementsAre(HasSubstr("edges of shadows")));
}

TEST(Completion, EachOfSeveralLights_HasAViewOfItsOwn_ALampFromNearBy) {
  Scene wide =
      make_scene_of({make_plane({40.0f, 40.0f}, 1), move_mesh(make_box({1.0f, 1.0f, 1.0f}, 1), {8.0, 0.5, 8.0}),
                     move_mesh(make_box({2.0f, 6.0f, 2.0f}, 1), {-10.0, 3.0, -10.0})});
  wide.light = place_in_sky({}, {60.0, 35.0});
  wide.light.name = "sun";
  Light& spot = wide.other_lights.emplace_back();
  spot.name = "spot";
  spot.kind = Spot{.position_ws = {10.0f, 3.0f, 9.0f}, .target_ws = {8.0f, 0.0f, 8.0f}};
  const std::vector<Scene> lit = separate_lights(complete(wide, {}, "x"));
  ASSERT_EQ(lit.size(), 2U);
  double shares[2];
  for (std::size_t i = 0; i < 2; ++i) {
    ASSERT_EQ(lit[i].cameras.size(), 1U);
    EXPECT_EQ(lit[i].cameras[0].name, lit[i].light.name);
    shares[i] = EdgeMeter(lit[i]).count(lit[i].cameras[0], lit[i].light, 16.0 / 9.0).share();
  }
  EXPECT_GT(shares[1], 5.0 * EdgeMeter(lit[1]).count(lit[0].cameras[0], lit[1].light, 16.0 / 9.0).share())
      << "than in the sun's view";
  EXPECT_GT(shares[1], 0.02);
  EXPECT_THAT(lit[0].notes, ElementsAre(HasSubstr("camera for the light 'sun' from azimuth"),
                                        AllOf(HasSubstr("camera for the light 'spot' from azimuth"),
                                              HasSubstr("near the light: edges of shadows touch"))));
}

// The edges of shadows in coarse views: whose they are, and how a view is scored.

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
  scene.meshes[1] = move_mesh(scene.meshes[1], {0.0, -1.5, 0.0});
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
  scene.meshes[1] = move_mesh(scene.meshes[1], {0.0, -1.7, 0.0});
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
  scene.materials.push_back({.name = "cut out", .base_color = {1, 1, 1, 0.2f}, .alpha_mode = AlphaMode::kMask});
  scene.meshes[1].material = 1;
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
  for (const Scene& lit : separate_lights(load(file.string(), {})))
    seen.push_back(is_light_in_view(lit, lit.cameras, 16.0 / 9.0));
  return seen;
}

TEST(LightInView, IsTheOneThatReachesASurface) {
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
