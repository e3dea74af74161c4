#include "harness/scene/lights/light_fit.h"

#include "harness/scene/load.h"
#include "tests/harness/scene/made_scenes.h"
#include "tests/harness/scene/same_scene.h"
#include "tests/test_files.h"

namespace shadowbench::scene {
namespace {

const std::vector<glm::vec3> kDirections{{0, -1, 0}, {0, 1, 0},      {1, 0, 0},         {-1, 0, 0},     {0, 0, 1},
                                         {0, 0, -1}, {1, -1, 1},     {-0.3f, -1, 0.2f}, {0.01f, -1, 0}, {5, -0.1f, 2},
                                         {1, 1, 0},  {1e-8f, -1, 0}, {-3, -4, 0}};

Scene make_scene(glm::vec3 direction, glm::vec3 offset = glm::vec3(0.0f)) {
  const glm::dvec3 by(offset);
  Scene scene = make_scene_of({move_mesh(make_plane({10.0f, 8.0f}, 4), by),
                               move_mesh(make_box({1.0f, 2.0f, 0.5f}, 2), by + glm::dvec3(1.0, 1.5, -2.0))},
                              Sun{glm::normalize(direction)});
  scene.meshes.front().casts_shadow = false;
  return scene;
}

/// What a 16-bit depth map rounds to 0 or 1.
constexpr double kHalfStep16 = 0.5 / 65535.0;

/// Every vertex lies at least `pad` of the map from its border and strictly inside the depth range.
void expect_inside(const Scene& scene, const LightFrustum& fit, double pad) {
  const auto slack = 1e-6 + 1e-7 * static_cast<double>(glm::length(scene.bounds().max)) / fit.texel_size_ws / 256.0;
  for (const Mesh& mesh : scene.meshes) {
    for (const Vertex& vertex : mesh.vertices) {
      const glm::dvec4 p = glm::dvec4(fit.uv_depth_from_world * glm::vec4(vertex.position_ws, 1.0f));
      ASSERT_EQ(p.w, 1.0);
      for (int i = 0; i < 2; ++i) {
        ASSERT_GE(p[i], pad - slack);
        ASSERT_LE(p[i], 1.0 - pad + slack);
      }
      ASSERT_GT(p.z, kHalfStep16);
      ASSERT_LT(p.z, 1.0 - kHalfStep16);
    }
  }
}

class LightFitTest : public testing::TestWithParam<FitMode> {};
INSTANTIATE_TEST_SUITE_P(Modes, LightFitTest, testing::Values(FitMode::kSphere, FitMode::kTight));

TEST_P(LightFitTest, AnyDirection_HoldsEveryVertexWithItsPadding) {
  for (const glm::vec3& direction : kDirections) {
    const Scene scene = make_scene(direction);
    expect_inside(scene, fit_light(scene, GetParam(), 256, 5.5), 5.5 / 256.0);
  }
}

TEST_P(LightFitTest, FarFromTheOrigin_StillHoldsEveryVertex) {
  for (const glm::vec3& direction : kDirections) {
    const Scene scene = make_scene(direction, {1e4f, -2e4f, 5e3f});
    expect_inside(scene, fit_light(scene, GetParam(), 256, 2.0), 2.0 / 256.0);
  }
}

TEST_P(LightFitTest, View_IsRigidAndLooksAlongTheLight) {
  for (const glm::vec3& direction : kDirections) {
    const LightFrustum fit = fit_light(make_scene(direction), GetParam(), 256, 1.0);
    const glm::dmat3 rotation(fit.light_from_world);
    EXPECT_NEAR(glm::determinant(rotation), 1.0, 1e-12);
    const glm::dmat3 product = rotation * glm::transpose(rotation);
    for (int i = 0; i < 3; ++i)
      for (int k = 0; k < 3; ++k) EXPECT_NEAR(product[i][k], i == k ? 1.0 : 0.0, 1e-12);
    EXPECT_NEAR((rotation * glm::dvec3(fit.direction_ws)).z, -1.0, 1e-6);
  }
}

TEST_P(LightFitTest, OneTexelInTheWorld_IsOneTexelInTheMapOnBothAxes) {
  const LightFrustum fit = fit_light(make_scene({1, -2, 0.5f}), GetParam(), 512, 3.0);
  EXPECT_NEAR(fit.width_ws, 512.0 * fit.texel_size_ws, 1e-9);
  const glm::dmat3 world_from_light = glm::transpose(glm::dmat3(fit.light_from_world));
  for (int axis = 0; axis < 2; ++axis) {
    const glm::dvec3 step = world_from_light[axis] * fit.texel_size_ws;
    const glm::dvec3 moved = glm::dmat3(glm::mat3(fit.uv_depth_from_world)) * step;
    EXPECT_NEAR(moved[axis] * 512.0, 1.0, 1e-4);
    EXPECT_NEAR(moved[1 - axis] * 512.0, 0.0, 1e-4);
  }
}

TEST_P(LightFitTest, DepthGrowsAlongTheLightByTheRange) {
  const LightFrustum fit = fit_light(make_scene({1, -2, 0.5f}), GetParam(), 512, 3.0);
  const glm::dvec3 step = glm::dvec3(fit.direction_ws) * fit.depth_range_ws;
  EXPECT_NEAR((glm::dmat3(glm::mat3(fit.uv_depth_from_world)) * step).z, 1.0, 1e-5);
}

TEST_P(LightFitTest, UvIsHalfOfClipSpacePlusHalf) {
  const LightFrustum fit = fit_light(make_scene({1, -2, 0.5f}), GetParam(), 512, 3.0);
  const glm::vec4 clip = fit.clip_from_world * glm::vec4(1.0f, 0.5f, -2.0f, 1.0f);
  const glm::vec4 uv = fit.uv_depth_from_world * glm::vec4(1.0f, 0.5f, -2.0f, 1.0f);
  EXPECT_NEAR(uv.x, clip.x * 0.5f + 0.5f, 1e-6f);
  EXPECT_NEAR(uv.y, clip.y * 0.5f + 0.5f, 1e-6f);
  EXPECT_NEAR(uv.z, clip.z, 1e-6f);
}

TEST_P(LightFitTest, FlatScenes_HaveADepthRange) {
  for (const glm::vec3& direction : {glm::vec3(0, -1, 0), glm::vec3(1, 0, 0)}) {
    Scene scene = make_scene(direction);
    scene.meshes.pop_back();
    const LightFrustum fit = fit_light(scene, GetParam(), 256, 1.0);
    EXPECT_GT(fit.depth_range_ws, 1e-4);
    expect_inside(scene, fit, 1.0 / 256.0);
  }
}

TEST(LightFitTest, TightMap_TouchesTheSceneOnItsLongerSide) {
  Scene scene = make_scene({0, -1, 0});
  const LightFrustum fit = fit_light(scene, FitMode::kTight, 100, 10.0);
  EXPECT_NEAR(fit.width_ws, 10.0 * 100.0 / 80.0, 1e-6);
  EXPECT_NEAR(fit.depth_range_ws, 2.5, 0.01);
}

TEST(LightFitTest, SphereMap_KeepsItsWidthWhenTheLightTurns) {
  const double width = fit_light(make_scene({0, -1, 0}), FitMode::kSphere, 256, 2.0).width_ws;
  for (const glm::vec3& direction : kDirections) {
    EXPECT_NEAR(fit_light(make_scene(direction), FitMode::kSphere, 256, 2.0).width_ws, width, 1e-9);
    EXPECT_LE(fit_light(make_scene(direction), FitMode::kTight, 256, 2.0).width_ws, width);
  }
}

TEST(LightFitTest, ReceiversThatCastNothing_AreInsideTheMap) {
  Scene scene = make_scene({0, -1, 0});
  EXPECT_GT(fit_light(scene, FitMode::kTight, 256, 0.0).width_ws, 9.9);
}

/// Where the frustum puts a point: u, v, depth.
glm::dvec3 seen(const LightFrustum& fit, const glm::dvec3& p) {
  return glm::dvec3(fit.uv_depth_from_world * glm::vec4(glm::vec3(p), 1.0f));
}

TEST_P(LightFitTest, Window_IsTheMap) {
  for (const glm::vec3& direction : kDirections) {
    Scene scene = make_scene(direction);
    const glm::dvec3 center(1.0, 0.5, -2.0), along(-to_light(scene.light, {}));
    scene.light.map_window = MapWindow{center, 3.0, MapWindow::Planes{-1.0, 4.0}};
    const LightFrustum fit = fit_light(scene, GetParam(), 256, 20.0);
    EXPECT_EQ(fit.width_ws, 3.0) << "no padding";
    EXPECT_EQ(fit.texel_size_ws, 3.0 / 256.0);
    EXPECT_EQ(fit.depth_range_ws, 5.0);
    EXPECT_LT(glm::length(seen(fit, center) - glm::dvec3(0.5, 0.5, 0.2)), 1e-5);
    EXPECT_NEAR(seen(fit, center + 4.0 * along).z, 1.0, 1e-5);
    EXPECT_NEAR(seen(fit, center - 1.0 * along).z, 0.0, 1e-5);
    const glm::dvec3 right = glm::transpose(glm::dmat3(fit.light_from_world))[0];
    EXPECT_NEAR(seen(fit, center + 1.5 * right).x, 1.0, 1e-5);
    EXPECT_NEAR((fit.clip_from_world * glm::vec4(glm::vec3(center + 1.5 * right), 1.0f)).x, 1.0f, 1e-5f);
  }
}

TEST_P(LightFitTest, WindowWithoutPlanes_KeepsTheFittedDepth) {
  Scene scene = make_scene({1, -2, 0.5f});
  const LightFrustum fitted = fit_light(scene, GetParam(), 256, 2.0);
  scene.light.map_window = MapWindow{glm::dvec3(1.0, 0.5, -2.0), 3.0, std::nullopt};
  const LightFrustum fit = fit_light(scene, GetParam(), 256, 2.0);
  EXPECT_EQ(fit.depth_range_ws, fitted.depth_range_ws);
  for (const glm::dvec3& p : {glm::dvec3(0.0), glm::dvec3(3.0, -1.0, 2.0)})
    EXPECT_NEAR(seen(fit, p).z, seen(fitted, p).z, 1e-6);
}

TEST(LightFitTest, PaddingThatLeavesNoTexel_IsAUsageError) {
  const auto fit = [] { fit_light(make_scene({0, -1, 0}), FitMode::kTight, 16, 8.0); };
  EXPECT_EQ(error_of(fit).kind(), ErrorKind::kUsage);
}

Camera make_narrow_camera(const glm::vec3& position, const glm::vec3& forward) {
  Camera camera = make_camera(position, forward);
  camera.vertical_fov_rad = 0.5f;
  return camera;
}

LightFrustum fit_view(const Scene& scene, const Camera& camera, bool snap = false) {
  return fit_light(scene, {FitMode::kView, 256, 3.0, snap, &camera, 1.5});
}

/// The place of a world point in the map, in texels.
glm::dvec2 texel_of(const LightFrustum& fit, const glm::dvec3& p) {
  return glm::dvec2(fit.light_from_world * glm::dvec4(p, 1.0)) / fit.texel_size_ws;
}

bool sees(const Camera& camera, const glm::dvec3& p) {
  const glm::dvec3 d = p - glm::dvec3(camera.position_ws), forward(camera.forward_ws);
  const glm::dvec3 right = glm::normalize(glm::cross(forward, glm::dvec3(camera.up_ws))),
                   up = glm::cross(right, forward);
  const double ahead = glm::dot(d, forward), tangent = std::tan(0.25);
  return ahead > 0.0 && std::abs(glm::dot(d, right)) <= 1.5 * tangent * ahead &&
         std::abs(glm::dot(d, up)) <= tangent * ahead;
}

TEST(LightFitView, HoldsEveryVisiblePointWithItsPadding_AndIsSmallerThanTight) {
  const Camera camera = make_narrow_camera({-3.0f, 2.0f, 4.0f}, {0.2f, -0.9f, -0.5f});
  for (const glm::vec3& direction : kDirections) {
    const Scene scene = make_scene(direction);
    for (const bool snap : {false, true}) {
      const LightFrustum fit = fit_view(scene, camera, snap);
      int seen = 0;
      for (double x = -5.0; x <= 5.0; x += 0.05) {
        for (double z = -4.0; z <= 4.0; z += 0.05) {
          if (!sees(camera, {x, 0.0, z})) continue;
          ++seen;
          const glm::dvec4 p = glm::dvec4(fit.uv_depth_from_world * glm::vec4(x, 0.0, z, 1.0));
          for (int i = 0; i < 2; ++i) {
            ASSERT_GE(p[i] * 256.0, 3.0 - 0.01);
            ASSERT_LE(p[i] * 256.0, 253.0 + 0.01);
          }
          ASSERT_GT(p.z, 0.0);
          ASSERT_LT(p.z, 1.0);
        }
      }
      EXPECT_GT(seen, 500);
      if (!snap) EXPECT_LT(fit.texel_size_ws, fit_light(scene, FitMode::kTight, 256, 3.0).texel_size_ws);
    }
  }
}

/// The box stands out of view, between the light and what is seen.
TEST(LightFitView, CasterOutOfView_LiesInsideTheDepthRange) {
  Scene scene = make_scene({0, -1, 0});
  const Camera camera = make_narrow_camera({1.0f, 1.0f, -1.0f}, {0.0f, -0.9f, -0.5f});
  const LightFrustum fit = fit_view(scene, camera);
  const glm::vec4 top = fit.uv_depth_from_world * glm::vec4(1.0f, 2.5f, -2.0f, 1.0f);
  EXPECT_FALSE(sees(camera, {1.0, 2.5, -2.0}));
  EXPECT_GT(top.z, 0.0f);
  EXPECT_GT(fit.depth_range_ws, 2.4);
  // Far from everything seen, it would only cost precision.
  for (Vertex& vertex : scene.meshes[1].vertices) vertex.position_ws.x += 100.0f;
  EXPECT_LT(fit_view(scene, camera).depth_range_ws, 0.1);
}

TEST(LightFitView, CameraThatSeesNothing_GetsTheTightFit) {
  const Scene scene = make_scene({1, -2, 0.5f});
  const Camera camera = make_narrow_camera({0.0f, 10.0f, 0.0f}, {0.1f, 1.0f, 0.0f});
  EXPECT_EQ(fit_view(scene, camera).width_ws, fit_light(scene, FitMode::kTight, 256, 3.0).width_ws);
}

TEST(LightFitSnap, CameraMovedByLessThanATexel_LeavesTheGridWhereItWas) {
  const Scene scene = make_scene({1, -2, 0.5f});
  const glm::dvec3 mark(0.3, 0.0, -0.7);
  const auto camera_at = [](int step) {
    return make_narrow_camera({-2.0f + 0.0031f * static_cast<float>(step), 3.0f, 4.0f}, {0.3f, -0.9f, -0.7f});
  };
  const LightFrustum first = fit_view(scene, camera_at(0), true), loose = fit_view(scene, camera_at(0), false);
  ASSERT_LT(0.0031, 0.5 * first.texel_size_ws);
  double moved = 0.0;
  for (int step = 1; step <= 40; ++step) {
    const LightFrustum snapped = fit_view(scene, camera_at(step), true);
    ASSERT_EQ(snapped.texel_size_ws, first.texel_size_ws);
    const glm::dvec2 shift = texel_of(snapped, mark) - texel_of(first, mark);
    EXPECT_NEAR(shift.x, std::round(shift.x), 1e-6);
    EXPECT_NEAR(shift.y, std::round(shift.y), 1e-6);
    const glm::dvec2 drift = texel_of(fit_view(scene, camera_at(step), false), mark) - texel_of(loose, mark);
    moved = std::max(moved, std::max(std::abs(drift.x - std::round(drift.x)), std::abs(drift.y - std::round(drift.y))));
  }
  EXPECT_GT(moved, 0.3) << "without snapping the grid follows the camera";
}

TEST_P(LightFitTest, Snapped_StillHoldsEveryVertexWithItsPadding) {
  for (const glm::vec3& direction : kDirections) {
    const Scene scene = make_scene(direction, {0.37f, 0.1f, -0.21f});
    expect_inside(scene,
                  fit_light(scene, FitRequest{.mode = GetParam(), .map_size = 256, .pad_texels = 5.5, .snap = true}),
                  5.5 / 256.0);
  }
}

TEST(FitRule, ReadsWhatItWrites) {
  for (const char* text : {"tight", "sphere", "view", "cascades:count=2,split=0.25,blend=0,depths=seen",
                           "cascades:count=4,split=1,blend=0.1,depths=all",
                           "cascades:count=3,splits=5/20.5,blend=0.1,depths=all,near=0.1,far=80",
                           "cascades:count=2,split=0.5,blend=0.1,depths=all,far=80"})
    EXPECT_EQ(describe_fit(parse_fit_rule(text)), text);
  EXPECT_EQ(describe_fit(parse_fit_rule("cascades")), "cascades:count=4,split=0.5,blend=0.1,depths=all");
  EXPECT_EQ(parse_fit_rule("cascades:split=logarithmic").cascades.split, 1.0);
  EXPECT_EQ(parse_fit_rule("cascades:split=uniform").cascades.split, 0.0);
}

TEST(FitRule, SaysWhatIsWrong) {
  const std::pair<const char*, const char*> wrong[] = {
      {"box", "unknown fit 'box'; there are sphere, tight, view, cascades"},
      {"tight:count=2", "'tight' takes no values"},
      {"cascades:count=5", "count is '5' and must be 2 .. 4"},
      {"cascades:count=2.5", "count is '2.5' and must be a whole number"},
      {"cascades:count", "count is ''"},
      {"cascades:split=even", "uniform (0), practical (0.5) or logarithmic (1)"},
      {"cascades:blend=0.7", "blend is '0.7' and must be 0 .. 0.5"},
      {"cascades:depths=some", "must be all or seen"},
      {"cascades:count=2,count=3", "'count' is given twice"},
      {"cascades:size=3", "cascades have no 'size'"},
      {"cascades:splits=20/5", "5 m follows 20 m"},
      {"cascades:splits=5/-20", "splits is '-20' and must be 0.001"},
      {"cascades:splits=5/20/40/60", "must be 1 to 3 depths in metres"},
      {"cascades:splits=5/20,far=15", "15 m follows 20 m"},
      {"cascades:splits=5/20,near=5", "5 m follows 5 m"},
      {"cascades:splits=5/20,count=2", "2 splits make 3 cascades, not 2"},
      {"cascades:splits=5,split=1", "split and splits are both given"},
      {"cascades:near=9,far=8", "8 m follows 9 m"},
  };
  for (const auto& [text, message] : wrong)
    EXPECT_THAT(error_of([&, text = text] { parse_fit_rule(text); }), is_error(ErrorKind::kUsage, message));
}

TEST(SplitDepths, AreUniform_Logarithmic_OrTheirMean) {
  const auto split = [](double share) { return split_depths({.count = 3, .split = share}, 1.0, 64.0); };
  EXPECT_THAT(split(0.0), testing::Pointwise(testing::DoubleNear(1e-12), {1.0, 22.0, 43.0, 64.0}));
  EXPECT_THAT(split(1.0), testing::Pointwise(testing::DoubleNear(1e-12), {1.0, 4.0, 16.0, 64.0}));
  EXPECT_THAT(split(0.5), testing::Pointwise(testing::DoubleNear(1e-12), {1.0, 13.0, 29.5, 64.0}));
}

FitRequest ask_for_cascades(const Camera& camera, const CascadeRule& rule, bool snap) {
  return {.mode = FitMode::kCascades,
          .map_size = 1024,
          .pad_texels = 4.0,
          .snap = snap,
          .camera = &camera,
          .aspect = 16.0 / 9.0,
          .cascades = rule};
}

std::vector<LightFrustum> fit(const Scene& scene, const Camera& camera, const CascadeRule& rule, bool snap = false) {
  return fit_layers(scene, ask_for_cascades(camera, rule, snap));
}

TEST(Cascades, EachHoldsWhatItServes_WithItsPadding) {
  const Scene scene = test::load_own_scene("avenue");
  const Camera& camera = scene.cameras.front();
  for (const bool snap : {false, true}) {
    int served = 0;
    for (const LightFrustum& layer : fit(scene, camera, {}, snap)) {
      const auto& slice = std::get<ViewSlice>(layer.share);
      for (const glm::dvec3& p : list_visible_corners(scene, camera, 16.0 / 9.0)) {
        const double depth = view_depth(camera, p);
        if (depth < slice.fade_in_begin || depth > slice.end_m) continue;
        ++served;
        const glm::dvec3 place = layer.place(p, 1024);
        test::expect_padded(place, 1024, 4.0);
      }
    }
    EXPECT_GT(served, 1000);
  }
}

TEST(Cascades, NearOnesHaveSmallerTexels_AndTheirSlicesMeet) {
  const Scene scene = test::load_own_scene("avenue");
  const auto layers = fit(scene, scene.cameras.front(), {.count = 4, .split = 1.0, .blend = 0.2});
  ASSERT_EQ(layers.size(), 4u);
  for (std::size_t i = 1; i < layers.size(); ++i) {
    EXPECT_GT(layers[i].texel_size_ws, 1.5 * layers[i - 1].texel_size_ws);
    const auto &near = std::get<ViewSlice>(layers[i - 1].share), &far = std::get<ViewSlice>(layers[i].share);
    EXPECT_EQ(near.fade_out_begin, far.fade_in_begin);
    EXPECT_EQ(near.fade_out_end, far.fade_in_end);
    EXPECT_LT(near.fade_out_begin, near.fade_out_end);
    EXPECT_EQ(layers[i].layer, static_cast<int>(i));
  }
}

std::vector<double> list_ends(const Scene& scene, const CascadeRule& rule) {
  std::vector<double> ends;
  for (const LightFrustum& layer : fit(scene, scene.cameras.front(), rule))
    ends.push_back(std::get<ViewSlice>(layer.share).end_m);
  return ends;
}

TEST(Cascades, EndWhereSplitsInMetresSay) {
  const Scene scene = test::load_own_scene("avenue");
  EXPECT_EQ(list_ends(scene, {.count = 3, .splits = {5.0, 20.0}, .near_m = 0.1, .far_m = 80.0}),
            (std::vector<double>{5.0, 20.0, 80.0}));
  const double in_view = list_ends(scene, {}).back();
  EXPECT_EQ(list_ends(scene, {.count = 2, .splits = {5.0}}), (std::vector<double>{5.0, in_view}));
  EXPECT_EQ(list_ends(scene, {.count = 2, .split = 1.0, .near_m = 1.0, .far_m = 64.0}),
            (std::vector<double>{8.0, 64.0}));
}

TEST(Cascades, BeyondWhatIsInView_AreRefused_UnlessAFarIsGiven) {
  const Scene scene = test::load_own_scene("avenue");
  const CascadeRule beyond{.count = 2, .splits = {1e4}};
  EXPECT_THROW(list_ends(scene, beyond), Error);
  EXPECT_EQ(list_ends(scene, {.count = 2, .splits = {1e4}, .far_m = 2e4}), (std::vector<double>{1e4, 2e4}));
}

/// Places of the grid, in its own texels: whole numbers where two grids are one.
glm::dvec2 place_of_grid(const LightFrustum& layer) {
  return glm::dvec2(layer.light_from_world[3]) / layer.texel_size_ws;
}

TEST(Cascades, SnappedOnes_KeepTheirTexelsInTheWorld_WhileTheCameraTurns) {
  const Scene scene = test::load_own_scene("avenue");
  Camera camera = scene.cameras.front();
  for (int step = 1; step <= 40; ++step) {
    const double turn = 0.02 * step;
    camera.forward_ws = glm::vec3(std::sin(turn), -0.08, -std::cos(turn));
    // What is in view reaches no farther, so that the slices stay: they follow the depths that are seen.
    FitRequest request = ask_for_cascades(camera, {.seen = true}, true);
    request.seen = DepthSpan{1.0, 200.0};
    const auto turned = fit_layers(scene, request);
    request.camera = &scene.cameras.front();
    const auto still = fit_layers(scene, request);
    ASSERT_EQ(still.size(), 4u);
    for (std::size_t i = 0; i < turned.size(); ++i) {
      EXPECT_EQ(turned[i].texel_size_ws, still[i].texel_size_ws);
      const glm::dvec2 moved = place_of_grid(turned[i]) - place_of_grid(still[i]);
      EXPECT_NEAR(moved.x, std::round(moved.x), 1e-6);
      EXPECT_NEAR(moved.y, std::round(moved.y), 1e-6);
    }
  }
}

}  // namespace
}  // namespace shadowbench::scene
