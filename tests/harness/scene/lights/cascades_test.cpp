#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "base/error.h"
#include "harness/scene/lights/light_fit.h"
#include "harness/scene/load.h"
#include "tests/harness/scene/test_files.h"

namespace shadowbench::scene {
namespace {

using testing::HasSubstr;

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
  for (const auto& [text, message] : wrong) {
    try {
      parse_fit_rule(text);
      ADD_FAILURE() << text;
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::kUsage);
      EXPECT_THAT(error.message(), HasSubstr(message));
    }
  }
}

TEST(SplitDepths, AreUniform_Logarithmic_OrTheirMean) {
  const auto split = [](double share) { return split_depths({.count = 3, .split = share}, 1.0, 64.0); };
  EXPECT_THAT(split(0.0), testing::Pointwise(testing::DoubleNear(1e-12), {1.0, 22.0, 43.0, 64.0}));
  EXPECT_THAT(split(1.0), testing::Pointwise(testing::DoubleNear(1e-12), {1.0, 4.0, 16.0, 64.0}));
  EXPECT_THAT(split(0.5), testing::Pointwise(testing::DoubleNear(1e-12), {1.0, 13.0, 29.5, 64.0}));
}

std::vector<LightFrustum> fit(const Scene& scene, const Camera& camera, CascadeRule rule, bool snap = false) {
  return fit_layers(scene, {.mode = FitMode::kCascades,
                            .map_size = 1024,
                            .pad_texels = 4.0,
                            .snap = snap,
                            .camera = &camera,
                            .aspect = 16.0 / 9.0,
                            .cascades = rule});
}

Scene load_avenue() {
  return load("avenue", {.scenes_folder = std::filesystem::path(SHADOWBENCH_SOURCE_DIR) / "data" / "scenes"});
}

TEST(Cascades, EachHoldsWhatItServes_WithItsPadding) {
  const Scene scene = load_avenue();
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
        for (int axis = 0; axis < 2; ++axis) {
          EXPECT_GE(place[axis], 4.0 - 1e-3);
          EXPECT_LE(place[axis], 1020.0 + 1e-3);
        }
        EXPECT_GT(place.z, 0.0);
        EXPECT_LT(place.z, 1.0);
      }
    }
    EXPECT_GT(served, 1000);
  }
}

TEST(Cascades, NearOnesHaveSmallerTexels_AndTheirSlicesMeet) {
  const Scene scene = load_avenue();
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
  const Scene scene = load_avenue();
  EXPECT_EQ(list_ends(scene, {.count = 3, .splits = {5.0, 20.0}, .near_m = 0.1, .far_m = 80.0}),
            (std::vector<double>{5.0, 20.0, 80.0}));
  const double in_view = list_ends(scene, {}).back();
  EXPECT_EQ(list_ends(scene, {.count = 2, .splits = {5.0}}), (std::vector<double>{5.0, in_view}));
  EXPECT_EQ(list_ends(scene, {.count = 2, .split = 1.0, .near_m = 1.0, .far_m = 64.0}),
            (std::vector<double>{8.0, 64.0}));
}

TEST(Cascades, BeyondWhatIsInView_AreRefused_UnlessAFarIsGiven) {
  const Scene scene = load_avenue();
  const CascadeRule beyond{.count = 2, .splits = {1e4}};
  EXPECT_THROW(list_ends(scene, beyond), Error);
  EXPECT_EQ(list_ends(scene, {.count = 2, .splits = {1e4}, .far_m = 2e4}), (std::vector<double>{1e4, 2e4}));
}

/// Places of the grid, in its own texels: whole numbers where two grids are one.
glm::dvec2 place_of_grid(const LightFrustum& layer) {
  return glm::dvec2(layer.light_from_world[3]) / layer.texel_size_ws;
}

TEST(Cascades, SnappedOnes_KeepTheirTexelsInTheWorld_WhileTheCameraTurns) {
  const Scene scene = load_avenue();
  Camera camera = scene.cameras.front();
  const auto first = fit(scene, camera, {}, true);
  for (int step = 1; step <= 40; ++step) {
    const double turn = 0.02 * step;
    camera.forward_ws = glm::vec3(std::sin(turn), -0.08, -std::cos(turn));
    // What is in view reaches no farther, so that the slices stay: they follow the depths that are seen.
    FitRequest request{.mode = FitMode::kCascades,
                       .map_size = 1024,
                       .pad_texels = 4.0,
                       .snap = true,
                       .camera = &camera,
                       .aspect = 16.0 / 9.0};
    request.cascades.seen = true;
    request.seen = DepthSpan{1.0, 200.0};
    Camera ahead = scene.cameras.front();
    FitRequest before = request;
    before.camera = &ahead;
    const auto turned = fit_layers(scene, request), still = fit_layers(scene, before);
    for (std::size_t i = 0; i < turned.size(); ++i) {
      EXPECT_EQ(turned[i].texel_size_ws, still[i].texel_size_ws);
      const glm::dvec2 moved = place_of_grid(turned[i]) - place_of_grid(still[i]);
      EXPECT_NEAR(moved.x, std::round(moved.x), 1e-6);
      EXPECT_NEAR(moved.y, std::round(moved.y), 1e-6);
    }
  }
  EXPECT_EQ(first.size(), 4u);
}

}  // namespace
}  // namespace shadowbench::scene
