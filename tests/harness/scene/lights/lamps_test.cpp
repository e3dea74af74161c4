#include "filters/depth_map.h"
#include "harness/scene/complete.h"
#include "harness/scene/lights/light.h"
#include "harness/scene/lights/light_fit.h"
#include "harness/scene/load.h"
#include "tests/harness/scene/gltf_parts.h"
#include "tests/harness/scene/made_scenes.h"
#include "tests/harness/scene/same_scene.h"

namespace shadowbench::scene {
namespace {

constexpr int kSpotMap = 256;
constexpr double kSpotPadding = 5.5;

/// A floor under a box, and a spot that looks at it from somewhere.
Scene make_spot_scene(const glm::vec3& position) {
  return make_scene_of({make_plane({10.0f, 8.0f}, 4), make_box({1.0f, 2.0f, 0.5f}, 2)},
                       Spot{position, {0.3f, 0.2f, -0.1f}, 50.0f, 40.0f, 0.1f});
}

const std::vector<glm::vec3> kLampPositions{
    {0.3f, 5.0f, -0.1f}, {4.0f, 3.0f, 2.0f}, {-5.0f, 0.5f, 0.0f}, {0.3f, -4.0f, -0.1f}};

TEST(SpotFit, HoldsItsCone_AndDepthIsLinearAlongTheAxis) {
  for (const glm::vec3& position : kLampPositions) {
    const Scene scene = make_spot_scene(position);
    const LightFrustum fit = fit_light(scene, FitMode::kTight, kSpotMap, kSpotPadding);
    ASSERT_TRUE(fit.perspective);
    const PerspectiveMap& map = *fit.perspective;
    const glm::dmat4 world_from_light = glm::inverse(fit.light_from_world);
    const double tangent = std::tan(glm::radians(25.0));
    const filters::DepthCurve curve{false, map.far_over_near()};
    for (const double distance : {map.near_m, 0.5 * (map.near_m + map.far_m), map.far_m}) {
      const double depth = (distance - map.near_m) / (map.far_m - map.near_m);
      for (const glm::dvec2& edge : {glm::dvec2(0, 0), {1, 0}, {-1, 0}, {0, 1}, {0, -1}}) {
        const glm::dvec4 point = world_from_light * glm::dvec4(tangent * distance * edge, -distance, 1.0);
        const glm::vec4 seen = fit.uv_depth_from_world * glm::vec4(point);
        const glm::dvec3 place = fit.place(glm::dvec3(point), kSpotMap);
        for (int i = 0; i < 2; ++i) {
          const double expected = 0.5 * kSpotMap + edge[i] * (0.5 * kSpotMap - kSpotPadding);
          EXPECT_NEAR(static_cast<double>(seen[i] / seen.w) * kSpotMap, expected, 0.01);
          EXPECT_NEAR(place[i], expected, 1e-9);
        }
        EXPECT_NEAR(static_cast<double>(seen.z), depth, 1e-6);
        EXPECT_NEAR(place.z, depth, 1e-9);
        const glm::vec4 clip = fit.clip_from_world * glm::vec4(point);
        EXPECT_NEAR(static_cast<double>(clip.z / clip.w), curve.store(depth), 1e-4) << "what the map stores";
      }
      const glm::dvec3 on_axis = map.beam.position_ws + distance * map.beam.axis_ws;
      EXPECT_NEAR(fit.texel_size_at(on_axis), 2.0 * tangent * distance / (kSpotMap - 2.0 * kSpotPadding), 1e-9);
    }
  }
}

TEST(SpotFit, EveryVertexInTheCone_HasADepth) {
  for (const glm::vec3& position : kLampPositions) {
    const Scene scene = make_spot_scene(position);
    const LightFrustum fit = fit_light(scene, FitMode::kTight, kSpotMap, kSpotPadding);
    int inside = 0;
    for (const Mesh& mesh : scene.meshes) {
      for (const Vertex& vertex : mesh.vertices) {
        if (fit.perspective->beam.cone_at(glm::dvec3(vertex.position_ws)) == 0.0) continue;
        const double depth = fit.place(glm::dvec3(vertex.position_ws), kSpotMap).z;
        EXPECT_GT(depth, 0.0);
        EXPECT_LT(depth, 1.0);
        ++inside;
      }
    }
    EXPECT_GT(inside, 0);
  }
}

TEST(SpotFit, MovesByPartsOfATexel) {
  const Scene scene = make_spot_scene(kLampPositions[1]);
  FitRequest request{.map_size = kSpotMap, .pad_texels = kSpotPadding};
  const glm::dvec3 point(0.4, 0.1, 0.2), before = fit_light(scene, request).place(point, kSpotMap);
  request.shift_texels = {0.25, -0.5};
  const glm::dvec3 moved = fit_light(scene, request).place(point, kSpotMap) - before;
  EXPECT_NEAR(moved.x, -0.25, 1e-9);
  EXPECT_NEAR(moved.y, 0.5, 1e-9);
  EXPECT_NEAR(moved.z, 0.0, 1e-12);
}

TEST(SpotFit, NothingInTheCone_AndThingsAtTheLamp_StillGiveAFrustum) {
  for (const glm::vec3& target : {glm::vec3(0.0f, 9.0f, 0.0f), glm::vec3(0.1f, 0.0f, 0.0f)}) {
    Scene scene = make_spot_scene({0.0f, 0.5f, 0.0f});  // within the box
    std::get<Spot>(scene.light.kind).target_ws = target;
    const LightFrustum fit = fit_light(scene, FitMode::kTight, kSpotMap, kSpotPadding);
    EXPECT_GT(fit.perspective->near_m, 0.0);
    EXPECT_GT(fit.perspective->far_m, fit.perspective->near_m);
    EXPECT_LE(fit.perspective->far_over_near(), 500.0 + 1e-9);
  }
}

TEST(Beam, FadesFromTheInnerConeToTheOuter) {
  Light light;
  light.kind = Spot{{0.0f, 2.0f, 0.0f}, {0.0f, 0.0f, 0.0f}, 60.0f, 40.0f, 0.0f};
  const Beam beam = *find_beam(light);
  const auto at = [&](double degrees) { return beam.cone_at({2.0 * std::tan(glm::radians(degrees)), 0.0, 0.0}); };
  EXPECT_EQ(at(0.0), 1.0);
  EXPECT_EQ(at(19.9), 1.0);
  EXPECT_EQ(at(30.1), 0.0);
  for (double degrees = 20.5; degrees < 30.0; degrees += 0.5) EXPECT_LT(at(degrees), at(degrees - 0.5));
  EXPECT_EQ(beam.cone_at({0.0, 4.0, 0.0}), 0.0) << "behind";
  EXPECT_EQ(beam.cone_at({0.0, 2.0, 0.0}), 0.0) << "the lamp itself";
}

TEST(Spot, WithASize_IsARectangleAlongItsMap) {
  Scene scene = make_spot_scene(kLampPositions[1]);
  auto& spot = std::get<Spot>(scene.light.kind);
  const truth::AreaLight disk = make_area_light(scene.light);
  EXPECT_NEAR(glm::length(disk.half_u()), 0.1, 1e-7);
  EXPECT_NEAR(light_size(scene.light), 0.2, 1e-7);
  spot.size_m = {0.6f, 0.2f};
  const truth::AreaLight rectangle = make_area_light(scene.light);
  const LightFrustum fit = fit_light(scene, FitMode::kTight, kSpotMap, kSpotPadding);
  const glm::dvec3 u = glm::dmat3(fit.light_from_world) * rectangle.half_u(),
                   v = glm::dmat3(fit.light_from_world) * rectangle.half_v();
  EXPECT_NEAR(glm::distance(u, glm::dvec3(0.3, 0.0, 0.0)), 0.0, 1e-7);
  EXPECT_NEAR(glm::distance(v, glm::dvec3(0.0, 0.1, 0.0)), 0.0, 1e-7);
  EXPECT_NEAR(std::numbers::pi * std::pow(0.5 * light_size(scene.light), 2.0), 0.6 * 0.2, 1e-7) << "a disk of its area";
}

/// A spot goes round its target, a lamp round the origin.
TEST(Lamps, GoRoundWhatTheyStandOver) {
  const auto place_of = [](const Light& light) {
    const auto* spot = std::get_if<Spot>(&light.kind);
    return spot ? spot->position_ws : std::get<PointLight>(light.kind).position_ws;
  };
  for (const LightKind& kind : {LightKind(Spot{{3.0f, 4.0f, 0.0f}, {0.0f, 0.0f, 0.0f}, 50.0f, 40.0f, 0.1f}),
                                LightKind(PointLight{.position_ws = {3.0f, 4.0f, 0.0f}})}) {
    Light light;
    light.kind = kind;
    const Light quarter = turn_about_vertical(light, glm::radians(90.0)), high = place_in_sky(light, {90.0, 90.0});
    EXPECT_NEAR(glm::distance(place_of(quarter), glm::vec3(0.0f, 4.0f, -3.0f)), 0.0f, 1e-5f);
    EXPECT_NEAR(glm::distance(place_of(high), glm::vec3(0.0f, 5.0f, 0.0f)), 0.0f, 1e-5f);
  }
}

/// The face that a direction belongs to: its longest axis, x before y before z.
int face_of(const glm::dvec3& way) {
  int axis = 0;
  for (int i = 1; i < 3; ++i)
    if (std::abs(way[i]) > std::abs(way[axis])) axis = i;
  return 2 * axis + (way[axis] < 0.0 ? 1 : 0);
}

TEST(PointLight, ItsSixFacesHoldEverythingAround_WithTheirPadding) {
  const Scene scene = test::load_own_scene("lantern");
  const auto faces = fit_layers(scene, {.map_size = 256, .pad_texels = 5.0});
  ASSERT_EQ(faces.size(), 6u);
  const glm::dvec3 light(std::get<PointLight>(scene.light.kind).position_ws);
  std::set<int> met;
  for (const Mesh& mesh : scene.meshes) {
    for (const Vertex& vertex : mesh.vertices) {
      const glm::dvec3 p(vertex.position_ws);
      const int face = face_of(p - light);
      met.insert(face);
      const glm::dvec3 place = faces[static_cast<std::size_t>(face)].place(p, 256);
      test::expect_padded(place, 256, 5.0);
    }
  }
  EXPECT_EQ(met.size(), 6u) << "the scene stands all around its light";
  for (const LightFrustum& face : faces) {
    EXPECT_EQ(face.depth_range_ws, faces.front().depth_range_ws) << "one curve stores the depth of all";
    EXPECT_EQ(face.texel_size_ws, faces.front().texel_size_ws);
  }
}

TEST(PointLight, ShinesAllAround_AndFallsOffWithTheSquareOfItsDistance) {
  const Scene scene = test::load_own_scene("lantern");
  for (const glm::vec3 p : {glm::vec3(0.1f, 3.0f, 0.05f), glm::vec3(-2.0f, 0.0f, 1.0f), glm::vec3(2.0f, 1.3f, -4.0f)})
    EXPECT_TRUE(shines_on(scene.light, p));
  EXPECT_EQ(light_size(scene.light), 2.0 * static_cast<double>(std::get<PointLight>(scene.light.kind).radius_m));
}

/// A sphere's rays leave every receiver around its own way to the centre; a disk's only where it faces the receiver.
TEST(PointLight, IsTracedAsASphere_FromEverySide) {
  Light light;
  light.kind = PointLight{.position_ws = {1.0f, 2.0f, 3.0f}, .radius_m = 0.25f};
  const truth::AreaLight area = make_area_light(light);
  for (int face = 0; face < kCubeFaces; ++face) {
    glm::dvec3 from(1.0, 2.0, 3.0);
    from[face / 2] += face % 2 == 0 ? 4.0 : -4.0;
    const truth::AreaLight::Aim aim = area.aim(from);
    const glm::dvec3 way = area.centre_direction(from);
    EXPECT_NEAR(glm::length(way), 4.0, 1e-6);
    for (const glm::dvec3& half : {aim.u, aim.v}) {
      EXPECT_NEAR(glm::dot(half, way), 0.0, 1e-9) << face;
      EXPECT_NEAR(glm::length(half), 0.25, 1e-3) << face;
    }
  }
}

// Warped maps of the sun: they hold what the camera sees, and each spends its texels as its method says.

constexpr int kWarpMap = 1024;
constexpr double kWarpPad = 6.0, kWarpAspect = 16.0 / 9.0;
constexpr FitMode kWarps[] = {FitMode::kFocused, FitMode::kLispsm, FitMode::kPsm, FitMode::kTsm, FitMode::kLogpsm};

LightFrustum fit_warp(const Scene& scene, FitMode mode, const glm::dvec2& shift_texels = {}) {
  return fit_light(scene, {.mode = mode,
                           .map_size = kWarpMap,
                           .pad_texels = kWarpPad,
                           .camera = &scene.cameras.front(),
                           .aspect = kWarpAspect,
                           .shift_texels = shift_texels});
}

/// A long floor that the camera looks along, from 2 m above it; the sun stands at right angles to its view.
Scene make_runway() {
  return make_scene_of({make_plane({40.0f, 200.0f}, 4)}, Sun{{0.0f, -1.0f, 0.0f}, 0.5f},
                       {make_camera({0.0f, 2.0f, 101.0f}, {0.0f, 0.0f, -1.0f})});
}

/// A place on the runway, that far ahead of the camera.
glm::dvec3 ahead(double depth) { return {0.0, 0.0, 101.0 - depth}; }

TEST(WarpedMap, HoldsAllThatIsSeen_WithItsPadding_AndItsCasters) {
  const Scene scene = test::load_own_scene("avenue");
  const auto seen = list_visible_corners(scene, scene.cameras.front(), kWarpAspect);
  for (const FitMode mode : kWarps) {
    const LightFrustum fit = fit_warp(scene, mode);
    glm::dvec2 least(kWarpMap), most(0.0);
    for (const glm::dvec3& p : seen) {
      const glm::dvec3 place = fit.place(p, kWarpMap);
      least = glm::min(least, glm::dvec2(place));
      most = glm::max(most, glm::dvec2(place));
      EXPECT_GT(place.z, 0.0);
      EXPECT_LT(place.z, 1.0);
    }
    for (int axis = 0; axis < 2; ++axis) {
      EXPECT_NEAR(least[axis], kWarpPad, 1e-6) << name_of(mode);
      EXPECT_NEAR(most[axis], kWarpMap - kWarpPad, 1e-6) << name_of(mode);
    }
    for (const Mesh& mesh : scene.meshes) {
      for (const Vertex& vertex : mesh.vertices) {
        const glm::dvec3 p(vertex.position_ws), place = fit.place(p, kWarpMap);
        const bool is_over = place.x >= 0.0 && place.x <= kWarpMap && place.y >= 0.0 && place.y <= kWarpMap;
        const double w = (glm::transpose(fit.clip_from_light * fit.light_from_world)[3] * glm::dvec4(p, 1.0)).x;
        if (mesh.casts_shadow && is_over && w > 0.0) EXPECT_GE(place.z, 0.0) << name_of(mode);
      }
    }
  }
}

/// Central differences of place().
TEST(WarpedMap, GradientsAreThoseOfItsPlaces_AndTheSunsWayChangesNone) {
  const Scene scene = test::load_own_scene("avenue");
  for (const FitMode mode : kWarps) {
    const LightFrustum fit = fit_warp(scene, mode);
    for (const glm::dvec3 p : {glm::dvec3(0.5, 0.0, -3.0), glm::dvec3(-2.0, 1.0, -40.0)}) {
      const truth::TexelGradients along = find_gradients(fit, p);
      for (int axis = 0; axis < 3; ++axis) {
        constexpr double kStep = 1e-4;
        glm::dvec3 step(0.0);
        step[axis] = kStep;
        const glm::dvec3 change = (fit.place(p + step, kWarpMap) - fit.place(p - step, kWarpMap)) / (2.0 * kStep);
        EXPECT_NEAR(along.u[axis], change.x, 1e-5 * glm::length(along.u)) << name_of(mode);
        EXPECT_NEAR(along.v[axis], change.y, 1e-5 * glm::length(along.v)) << name_of(mode);
      }
      const glm::dvec3 moved = fit.place(p + 0.7 * glm::dvec3(fit.direction_ws), kWarpMap);
      EXPECT_NEAR(glm::distance(glm::dvec2(moved), glm::dvec2(fit.place(p, kWarpMap))), 0.0, 1e-6) << name_of(mode);
      EXPECT_GT(glm::dot(glm::cross(along.u, along.v), fit.to_light(p)), 0.0) << "not mirrored: " << name_of(mode);
      EXPECT_NEAR(fit.texel_size_at(p), 1.0 / std::sqrt(glm::length(glm::cross(along.u, along.v))), 1e-12);
    }
  }
}

/// The length of a texel across and along the view, metres.
glm::dvec2 texel_at(const LightFrustum& fit, double depth) {
  const truth::TexelGradients along = find_gradients(fit, ahead(depth));
  const double across_u = std::hypot(along.u.x, along.v.x), along_view = std::hypot(along.u.z, along.v.z);
  return {1.0 / across_u, 1.0 / along_view};
}

TEST(WarpedMap, EachMethodSpendsItsTexelsAsItsPaperSays) {
  const Scene scene = make_runway();
  const DepthSpan seen = [&] {
    DepthSpan span{1e9, 0.0};
    for (const glm::dvec3& p : list_visible_corners(scene, scene.cameras.front(), kWarpAspect)) {
      const double depth = view_depth(scene.cameras.front(), p);
      span = {std::min(span.near_m, depth), std::max(span.far_m, depth)};
    }
    return span;
  }();
  const double a = 1.2 * seen.near_m, b = 0.9 * seen.far_m, ratio = b / a;
  const auto growth = [&](FitMode mode) {
    const LightFrustum fit = fit_warp(scene, mode);
    return texel_at(fit, b) / texel_at(fit, a);
  };
  EXPECT_NEAR(growth(FitMode::kFocused).x, 1.0, 1e-9);
  EXPECT_NEAR(growth(FitMode::kFocused).y, 1.0, 1e-9);
  // Under a sun overhead the camera's own projection is the map's: across it is fair, along it squares the growth.
  EXPECT_NEAR(growth(FitMode::kPsm).x, ratio, 1e-6 * ratio);
  EXPECT_NEAR(growth(FitMode::kPsm).y, ratio * ratio, 1e-6 * ratio * ratio);
  // A logarithm is fair along both.
  EXPECT_NEAR(growth(FitMode::kLogpsm).x, ratio, 1e-6 * ratio);
  EXPECT_NEAR(growth(FitMode::kLogpsm).y, ratio, 1e-6 * ratio);
  // w = n + depth - near, with n = near + sqrt(near far).
  const double n = seen.near_m + std::sqrt(seen.near_m * seen.far_m);
  const double of_lispsm = (n + b - seen.near_m) / (n + a - seen.near_m);
  EXPECT_NEAR(growth(FitMode::kLispsm).x, of_lispsm, 1e-6 * of_lispsm);
  EXPECT_NEAR(growth(FitMode::kLispsm).y, of_lispsm * of_lispsm, 1e-6 * of_lispsm * of_lispsm);
  // A quarter of the length has four fifths of the map.
  const LightFrustum trapezoid = fit_warp(scene, FitMode::kTsm);
  const auto row_at = [&](double depth) { return trapezoid.place(ahead(depth), kWarpMap).y; };
  const double used = kWarpMap - 2.0 * kWarpPad, length = seen.far_m - seen.near_m;
  EXPECT_NEAR((row_at(seen.near_m + kTrapezoidFocus * length) - kWarpPad) / used, 0.8, 1e-6);
}

TEST(WarpedMap, MovesByTexels_AsItIsAsked) {
  const Scene scene = test::load_own_scene("avenue");
  for (const FitMode mode : kWarps) {
    const LightFrustum still = fit_warp(scene, mode), moved = fit_warp(scene, mode, {0.25, -0.5});
    const glm::dvec3 p(0.5, 0.0, -3.0);
    const glm::dvec2 step(moved.place(p, kWarpMap) - still.place(p, kWarpMap));
    EXPECT_NEAR(glm::length(step - glm::dvec2(0.25, -0.5)), 0.0, 1e-6) << name_of(mode);
  }
}

TEST(WarpedMap, StaysFiniteWhereThereIsNothingToWarp) {
  Scene along = make_runway();
  along.cameras.front().forward_ws = {0.0f, -1.0f, 0.0f};  // along the light
  along.cameras.front().up_ws = {0.0f, 0.0f, -1.0f};
  Scene flat = make_runway();
  flat.cameras.front().orthographic_height_m = 3.0f;
  Scene inside = make_runway();
  inside.cameras.front().position_ws = {0.0f, 0.0f, 50.0f};  // in the floor
  Scene dueling = make_runway();                             // looks into the sun
  dueling.light.kind = Sun{glm::normalize(glm::vec3(0.05f, -0.1f, 1.0f)), 0.5f};
  Scene behind = make_runway();  // the sun stands behind the camera
  behind.light.kind = Sun{glm::normalize(glm::vec3(0.0f, -0.3f, -1.0f)), 0.5f};
  for (const Scene* scene : {&along, &flat, &inside, &dueling, &behind}) {
    for (const FitMode mode : kWarps) {
      const LightFrustum fit = fit_warp(*scene, mode);
      for (const glm::dvec3& p : list_visible_corners(*scene, scene->cameras.front(), kWarpAspect)) {
        const glm::dvec3 place = fit.place(p, kWarpMap);
        EXPECT_TRUE(test::is_padded(place, kWarpMap, kWarpPad)) << name_of(mode);
        EXPECT_TRUE(std::isfinite(fit.texel_size_at(p)));
      }
      EXPECT_GT(fit.texel_size_ws, 0.0);
      EXPECT_TRUE(std::isfinite(fit.texel_size_ws));
    }
  }
  Scene away = make_runway();
  away.cameras.front().forward_ws = {0.0f, 0.0f, 1.0f};  // sees nothing
  for (const FitMode mode : kWarps) EXPECT_GT(fit_warp(away, mode).texel_size_ws, 0.0);
}

TEST(WarpedMap, CannotBeSnapped) {
  const Scene scene = test::load_own_scene("avenue");
  for (const FitMode mode : kWarps) {
    EXPECT_THAT(error_of([&] { fit_light(scene, {.mode = mode, .snap = true, .camera = &scene.cameras.front()}); }),
                is_error(ErrorKind::kUsage, "--snap on"));
  }
}

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
