// Filters that are drawn frame by frame, and what accumulating the frames makes of them.

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>

#include "harness/measure/accumulation.h"
#include "tests/harness/render/bench_fixture.h"

namespace shadowbench::measure {
namespace {

constexpr int kAccumulated = 32;

/// The ball, small, with all that a task has.
class AccumulationTest : public ::testing::Test {
 protected:
  AccumulationTest()
      : scene_(test::load_builtin("ball")),
        renderer_(make_renderer(gl::Backend::kAuto, options_.resources)),
        cache_({}, [](const std::string&) {}),
        assets_(renderer_, options_, scene_, cache_, 5.0),
        rig_{renderer_, options_, task_, assets_} {}

  static filters::FilterRequest request(const std::string& text) {
    return test::catalogue().parse_requests(text).front();
  }

  records::AccumulationRecord measure(AccumulationMeter& meter, const std::string& filter) {
    AccumulatedImages images;
    return meter.measure(request(filter), images).value();
  }

  static const records::ResolveRecord& find(const records::AccumulationRecord& record, const std::string& rule) {
    return *std::ranges::find_if(
        record.resolves, [&](const auto& each) { return each.rule == rule && !each.jitter; });
  }

  options::RunOptions options_ = [] {
    options::RunOptions options;
    options.resources = options::find_resources();
    options.width = 160;
    options.height = 90;
    options.frames = kAccumulated;
    return options;
  }();
  scene::Scene scene_;
  Renderer renderer_;
  truth::TruthCache cache_;
  SceneAssets assets_;
  SceneTask task_{&scene_, &scene_.cameras.front(), 256, {}};
  TaskRig rig_;
};

TEST(Jitter, TakesEightPlacesInTurn_WithinAPixel) {
  glm::dvec2 sum(0.0);
  for (int i = 0; i < kJitters; ++i) {
    const glm::dvec2 place = find_jitter(i);
    EXPECT_LT(std::max(std::abs(place.x), std::abs(place.y)), 0.5);
    EXPECT_EQ(place, find_jitter(i + kJitters));
    for (int k = 0; k < i; ++k) EXPECT_NE(place, find_jitter(k));
    sum += place / static_cast<double>(kJitters);
  }
  EXPECT_LT(glm::length(sum), 0.1);
}

TEST_F(AccumulationTest, FilterWithoutNoise_FramesEqualOne_ToTheBit) {
  const LightMap& map = assets_.light_map(*task_.camera, task_.map_size);
  const render::GBuffer& gbuffer = assets_.gbuffer(*task_.camera);
  for (const char* filter : {"pcf2x2", "vsm", "poisson:rotation=none"}) {
    FrameDrawing drawing(rig_, request(filter));
    std::vector<render::ResolvePass> resolves = make_resolves(rig_);
    drawing.draw({0, scene_.light, map, gbuffer}, resolves);
    std::vector<images::Image> first;
    for (const auto& resolve : resolves) first.push_back(render::read_image(resolve.texture(), 1));
    for (std::uint32_t i = 1; i < kAccumulated; ++i) drawing.draw({i, scene_.light, map, gbuffer}, resolves);
    for (std::size_t i = 0; i < resolves.size(); ++i)
      EXPECT_EQ(render::read_image(resolves[i].texture(), 1).texels, first[i].texels)
          << filter << ", " << list_resolve_rules()[i].name;
  }
}

/// Of the plain mean: an exponential one has a floor.
TEST_F(AccumulationTest, NoiseOfAMean_FallsWithTheRootOfFrames_AndFasterWithBlueNoise) {
  AccumulationMeter meter(rig_);
  const records::AccumulationRecord white = measure(meter, "poisson:taps=4,rotation=per-pixel");
  const std::vector<double>& falling = *find(white, "mean").noise;
  for (const std::size_t n : {2, 4, 8, 16, 32}) {
    const double root =
        falling[0] * std::sqrt(1.0 / static_cast<double>(n) + 1.0 / 256.0);  // with the noise of 256 frames
    std::printf("white noise: %zu frames %.5f, 1/sqrt %.5f\n", n, falling[n - 1], root);
    EXPECT_NEAR(falling[n - 1], root, 0.08 * root) << n;
  }
  for (const char* rotation : {"blue-noise", "interleaved-gradient"}) {
    const records::AccumulationRecord other = measure(meter, std::string("poisson:taps=4,rotation=") + rotation);
    const std::vector<double>& noise = *find(other, "mean").noise;
    std::printf("%s: 8 frames %.5f, 32 frames %.5f of one's %.5f\n", rotation, noise[7], noise[31], noise[0]);
    EXPECT_LT(noise[7], 0.6 * falling[7]);
    EXPECT_LT(noise[31], 0.5 * falling[31]);
  }
  const std::vector<double>& floor = *find(white, "exponential").noise;
  EXPECT_NEAR(floor.back() / falling[0], std::sqrt(0.1 / 1.9), 0.04) << "the sum of squared weights, 0.1 / (2 - 0.1)";
}

TEST_F(AccumulationTest, Ghosts_FadeByTheWeight_AndSoonerWithClamping) {
  const GhostBench ghosts = make_ghost_bench(rig_);
  ASSERT_EQ(ghosts.motions.size(), 3u) << ghosts.absent;
  FrameDrawing drawing(rig_, request("none"));
  std::vector<images::Image> images;
  for (const records::GhostRecord& ghost : measure_ghosts(rig_, ghosts, drawing, images)) {
    if (!ghost.at_stop || ghost.rule != "exponential") continue;
    SCOPED_TRACE(ghost.texels);
    EXPECT_GT(*ghost.at_stop, 0.3);
    EXPECT_NEAR(*ghost.frames_until, std::ceil(std::log(records::kGhostLimit / *ghost.at_stop) / std::log(0.9)), 1);
  }
  const auto records = measure_ghosts(rig_, ghosts, drawing, images);
  EXPECT_LT(records[5].frames_until.value(), 4) << "16 texels a frame, clamped";
  EXPECT_EQ(images.size(), 2u);
}

/// A light that stands overhead moves no shadow when it turns about the vertical.
TEST_F(AccumulationTest, LightOverhead_HasNoGhosts) {
  scene_.light = scene::place_in_sky(scene_.light, {0.0, 90.0});
  EXPECT_THAT(make_ghost_bench(rig_).absent, ::testing::HasSubstr("no shadow in view moves"));
}

}  // namespace
}  // namespace shadowbench::measure
