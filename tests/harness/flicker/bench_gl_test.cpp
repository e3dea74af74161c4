#include <gtest/gtest.h>

#include <algorithm>

#include "harness/flicker/bench.h"
#include "harness/run/scene_loading.h"

namespace shadowbench::flicker {
namespace {

constexpr int kFrames = 6;
const auto kIgnore = [](int) {};

/// The cubes, a small map and the built-in filters.
class FlickerBenchTest : public ::testing::Test {
 protected:
  FlickerBenchTest()
      : options_(make_options()),
        scene_(run::load_scene(options_, "cubes")),
        renderer_(measure::make_renderer(gl::Backend::kAuto, options_.resources)),
        cache_({}, [](const std::string&) {}),
        bench_(renderer_, options_, scene_, cache_) {}

  static options::RunOptions make_options() {
    options::RunOptions options;
    options.resources = options::find_resources();
    options.filters = filters::Catalogue(options.resources.filters).parse_requests("");
    options.map_sizes = {128};
    options.width = 160;
    options.height = 90;
    return options;
  }

  double step_of(Motion motion) const {
    return choose_step(motion, scene_, bench_.receivers().image, bench_.following(false));
  }

  std::vector<metrics::FlickerStats> measure(Motion motion, bool snap, double step) {
    const auto frames = make_frames(motion, scene_, step, kFrames);
    const auto frusta = fit_frames(motion, scene_, frames, bench_.following(snap));
    const auto mask = mark_receivers(bench_.receivers().image, frusta, 128, bench_.following(snap).pad_texels);
    truth_ = bench_.trace(motion, frames, mask, kIgnore);
    return bench_.measure(frusta, mask, truth_, kIgnore);
  }

  const std::string& label(std::size_t filter) const { return options_.filters[filter].spec.id; }

  options::RunOptions options_;
  scene::Scene scene_;
  measure::Renderer renderer_;
  truth::TruthCache cache_;
  FlickerBench bench_;
  TruthFrames truth_;
};

TEST_F(FlickerBenchTest, LightAtRest_NothingFlickers) {
  const auto stats = measure(Motion::kLight, false, 0.0);
  for (std::size_t i = 0; i < stats.size(); ++i) {
    EXPECT_GT(stats[i].receivers, 1000);
    EXPECT_EQ(stats[i].change, 0.0) << label(i);
    EXPECT_EQ(stats[i].truth_change, 0.0) << "a pixel's random numbers are the same in all frames";
    EXPECT_EQ(stats[i].flicker, 0.0) << label(i);
  }
}

TEST_F(FlickerBenchTest, MovedCamera_FlickersOnlyWithoutSnapping) {
  const double step = step_of(Motion::kCamera);
  const auto free = measure(Motion::kCamera, false, step), snapped = measure(Motion::kCamera, true, step);
  EXPECT_FALSE(truth_.traced);
  for (std::size_t i = 0; i < free.size(); ++i) {
    EXPECT_GT(free[i].flicker, 1e-3) << label(i);
    // Most keep a few percent; moments that are packed into 32 bits, whose steps a rounding decides about, keep 11 %.
    EXPECT_LT(snapped[i].flicker, 0.125 * free[i].flicker) << label(i);
    EXPECT_NEAR(free[i].flicker, free[i].change, 1e-12) << "the truth stands still";
  }
}

TEST_F(FlickerBenchTest, TurnedLight_MovesTheTruth_AndEveryFilter) {
  const auto stats = measure(Motion::kLight, true, step_of(Motion::kLight));
  EXPECT_TRUE(truth_.traced);
  EXPECT_GT(truth_.noise, 0.0);
  for (std::size_t i = 0; i < stats.size(); ++i) {
    EXPECT_GT(stats[i].truth_change, truth_.noise);
    EXPECT_GT(stats[i].change, 0.0) << label(i);
    EXPECT_GT(stats[i].flicker, 0.0) << label(i);
  }
}

/// A kernel averages over the texels that come and go under a moving grid.
TEST_F(FlickerBenchTest, WiderKernel_FlickersLess) {
  const auto stats = measure(Motion::kCamera, false, step_of(Motion::kCamera));
  const auto flicker = [&](const std::string& id) {
    const auto found = std::ranges::find_if(
        options_.filters, [&](const filters::FilterRequest& request) { return request.spec.id == id; });
    return stats[static_cast<std::size_t>(found - options_.filters.begin())].flicker;
  };
  EXPECT_GT(flicker("none"), flicker("pcf2x2"));
  EXPECT_GT(flicker("pcf2x2"), flicker("tent3x3"));
}

}  // namespace
}  // namespace shadowbench::flicker
