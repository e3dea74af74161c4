#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

#include "base/error.h"
#include "harness/scene/complete.h"
#include "harness/scene/lights/light.h"
#include "harness/scene/lights/light_fit.h"
#include "harness/scene/load.h"
#include "harness/scene/mesh_tools.h"

namespace shadowbench::scene {
namespace {

// Warped maps of the sun: they hold what the camera sees, and each spends its texels as its method says.

constexpr int kWarpMap = 1024;
constexpr double kWarpPad = 6.0, kWarpAspect = 16.0 / 9.0;
constexpr FitMode kWarps[] = {FitMode::kFocused, FitMode::kLispsm, FitMode::kPsm, FitMode::kTsm, FitMode::kLogpsm};

Scene load_deep_scene() {
  return load("avenue", {.scenes_folder = std::filesystem::path(SHADOWBENCH_SOURCE_DIR) / "data" / "scenes"});
}

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
  Scene scene;
  scene.name = "runway";
  scene.meshes.push_back(make_plane({40.0f, 200.0f}, 4));
  scene.meshes.back().material = 0;
  scene.materials.emplace_back();
  scene.light.kind = Sun{{0.0f, -1.0f, 0.0f}, 0.5f};
  Camera camera;
  camera.position_ws = {0.0f, 2.0f, 101.0f};
  camera.forward_ws = {0.0f, 0.0f, -1.0f};
  camera.vertical_fov_rad = 0.8f;
  scene.cameras.push_back(camera);
  return scene;
}

/// A place on the runway, that far ahead of the camera.
glm::dvec3 ahead(double depth) { return {0.0, 0.0, 101.0 - depth}; }

TEST(WarpedMap, HoldsAllThatIsSeen_WithItsPadding_AndItsCasters) {
  const Scene scene = load_deep_scene();
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
  const Scene scene = load_deep_scene();
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
  const Scene scene = load_deep_scene();
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
        for (int axis = 0; axis < 2; ++axis) {
          EXPECT_GE(place[axis], kWarpPad - 1e-3) << name_of(mode);
          EXPECT_LE(place[axis], kWarpMap - kWarpPad + 1e-3) << name_of(mode);
        }
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
  const Scene scene = load_deep_scene();
  for (const FitMode mode : kWarps) {
    try {
      fit_light(scene, {.mode = mode, .snap = true, .camera = &scene.cameras.front()});
      FAIL() << name_of(mode);
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::kUsage);
      EXPECT_NE(error.message().find("--snap on"), std::string::npos) << error.message();
    }
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
