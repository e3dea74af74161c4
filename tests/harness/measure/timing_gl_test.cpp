#include "harness/measure/accumulation.h"
#include "harness/measure/scene_measurement.h"
#include "harness/measure/stability_meter.h"
#include "harness/measure/timing.h"
#include "harness/run/run_plan.h"
#include "tests/harness/measure/stand.h"
#include "tests/harness/render/bench_fixture.h"
#include "tests/test_files.h"

namespace shadowbench::test {
namespace {

using namespace measure;

constexpr int kMapSize = 512;

/// A small scene to time filters in.
struct Timed : Stand {
  Timed() : Stand(load_builtin("cubes"), make_run_options(320, 180), 6.0) {}

  /// The own time of a filter, as records hold it.
  records::OwnTime time(const filters::FilterRequest& request) {
    const scene::Camera& camera = scene.cameras.front();
    LightMap& map = assets.light_map(camera, kMapSize);
    const auto passes = make_filter_passes(renderer, options, scene, map, request);
    render::ImageTarget target("visibility", GL_R32F, options.width, options.height);
    draw_visibility(*passes, map.map, assets.gbuffer(camera), target);
    const std::vector<render::FilterPasses*> filters = {passes.get()};
    const auto empty = make_empty_lookups(renderer, options, scene, map, filters);
    const RoundTimes times = time_rounds({.filters = filters,
                                          .empties = empty.passes,
                                          .draw_map = [&] { assets.redraw(map); },
                                          .map = map.map,
                                          .gbuffer = assets.gbuffer(camera),
                                          .timer = renderer.timer},
                                         {.limits = options::RoundLimits::exactly(40)});
    return find_difference(times.filters[0].lookup, times.empties[0]);
  }
};

/// A filter of the user's that returns this expression.
filters::FilterRequest make_filter(const std::string& expression) {
  return filters::request_of_file(
      filters::write_filter("", "float visibility(Receiver r) { return " + expression + "; }\n"));
}

// A 95 % interval misses now and then: of three, one must hold 0.
TEST(OwnTime, OfAConstantIsNothing) {
  Timed timed;
  bool holds_nothing = false;
  for (int attempt = 0; attempt < 3 && !holds_nothing; ++attempt) {
    const records::OwnTime time = timed.time(make_filter("0.5"));
    holds_nothing = time.ci95.low <= 0.0 && time.ci95.high >= 0.0;
  }
  EXPECT_TRUE(holds_nothing);
}

TEST(OwnTime, OfAComparisonIsMoreThanNothing) {
  const records::OwnTime time = Timed().time(make_filter("compare_2x2(r, vec2(0.0), r.depth)"));
  EXPECT_GT(time.ci95.low, 0.0);
}

TEST(OwnTime, EmptyLookupsReadWhatTheirFiltersRead) {
  Timed timed;
  const records::OwnTime time = timed.time(make_filter("r.normal_ws.x + r.position_ws.y + r.n_dot_l"));
  EXPECT_LT(std::abs(time.median), 1.0) << "ms: without the reads in the empty lookup it would be several";
}

TEST(Timing, TwiceTheTaps_TakeLonger) {
  Bench bench(load_builtin("cubes"), 512, 480, 270);
  const auto requests = built_in().parse_requests("none,poisson:taps=16,poisson:taps=32");
  std::vector<std::unique_ptr<render::FilterPasses>> filters;
  std::vector<render::FilterPasses*> pointers;
  for (const auto& request : requests) {
    filters.push_back(
        std::make_unique<render::FilterPasses>(bench.shaders(), request, bench.map(), bench.light(request)));
    pointers.push_back(filters.back().get());
  }
  const gl::TimerKind timer = gl::choose_timer(shared_context());
  const RoundTimes times =
      time_rounds({.filters = pointers, .map = bench.map(), .gbuffer = bench.gbuffer(), .timer = timer},
                  {.limits = options::RoundLimits::exactly(31)});
  const records::Ratio ratio = find_ratio(times.filters[2].lookup, times.filters[1].lookup);
  EXPECT_EQ(times.map.size(), 31u);
  EXPECT_TRUE(times.filters[0].prefilter.empty());
  // The lookup is most of the pass; a clock that times the queueing would read about 1.
  EXPECT_GT(ratio.median, 1.3);
}

// Filters that are drawn frame by frame, and what accumulating the frames makes of them.

constexpr int kAccumulated = 32;

/// The ball, small, with all that a task has.
class AccumulationTest : public ::testing::Test, protected Stand {
 protected:
  AccumulationTest() : Stand(load_builtin("ball"), make_run_options(160, 90), 5.0) { options.frames = kAccumulated; }

  static filters::FilterRequest request(const std::string& text) { return test::request_of(text); }

  records::AccumulationRecord measure(AccumulationMeter& meter, const std::string& filter) {
    AccumulatedImages images;
    return meter.measure(request(filter), images).value();
  }

  static const records::ResolveRecord& find(const records::AccumulationRecord& record, const std::string& rule) {
    return *std::ranges::find_if(
        record.resolves, [&](const auto& each) { return each.rule == rule && !each.jitter; });
  }

  SceneTask task_{&scene, &scene.cameras.front(), 256, {}};
  TaskRig rig_{renderer, options, task_, assets};
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
  const LightMap& map = assets.light_map(*task_.camera, task_.map_size);
  const render::GBuffer& gbuffer = assets.gbuffer(*task_.camera);
  for (const char* filter : {"pcf2x2", "vsm", "poisson:rotation=none"}) {
    FrameDrawing drawing(rig_, request(filter));
    std::vector<render::ResolvePass> resolves = make_resolves(rig_);
    drawing.draw({0, scene.light, map, gbuffer}, resolves);
    std::vector<images::Image> first;
    for (const auto& resolve : resolves) first.push_back(render::read_image(resolve.texture(), 1));
    for (std::uint32_t i = 1; i < kAccumulated; ++i) drawing.draw({i, scene.light, map, gbuffer}, resolves);
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
    EXPECT_NEAR(falling[n - 1], root, 0.08 * root) << n;
  }
  for (const char* rotation : {"blue-noise", "interleaved-gradient"}) {
    const records::AccumulationRecord other = measure(meter, std::string("poisson:taps=4,rotation=") + rotation);
    const std::vector<double>& noise = *find(other, "mean").noise;
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
  scene.light = scene::place_in_sky(scene.light, {0.0, 90.0});
  EXPECT_THAT(make_ghost_bench(rig_).absent, HasSubstr("no shadow in view moves"));
}

// What a run calls flicker.

/// The flicker of `none`, as a run notes it.
double measure_flicker(const std::string& scene_name, const std::string& fit, bool snap) {
  options::RunOptions options = make_run_options(160, 90);
  options.fit = scene::parse_fit_rule(fit);
  options.snap = snap;
  Stand stand(load_builtin(scene_name), options, 4.0);
  const scene::Camera& camera = stand.scene.cameras.front();
  const SceneTask task{&stand.scene, &camera, 512, {options.reference}};
  MeasuredCell cell = std::move(measure_scene({stand.renderer, stand.options, task, stand.assets}).cells.front());
  score(cell, stand.assets.truth(camera));
  return cell.record.error.flicker.value();
}

TEST(Flicker, OfASnappedMapUnderAStandingSun_IsNothingToTheBit) {
  for (const char* fit : {"cascades:count=4,split=logarithmic", "view"}) {
    EXPECT_EQ(measure_flicker("avenue", fit, true), 0.0) << fit;
    EXPECT_GT(measure_flicker("avenue", fit, false), 0.02) << fit;
  }
}

TEST(Flicker, OfAMapThatNoCameraMoves_IsThatUnderATurningLight) {
  EXPECT_GT(measure_flicker("avenue", "tight", true), 0.02);
  EXPECT_EQ(measure_flicker("lamp", "view", false), measure_flicker("lamp", "tight", false));
}

// Where the numbers of real maps break, and that the defaults of every filter stay clear of it on every built-in scene.

/// Draws cells with stability, without timing or truth to speak of.
std::vector<MeasuredCell> measure(const std::string& scene_name, const std::string& filters, int map_size = 512,
                                  int width = 240, int height = 135) {
  options::RunOptions options = make_run_options(width, height);
  options.filters = built_in().parse_requests(filters);
  options.phases = 1;  // numbers are looked at in the first of them alone
  options.truth = false;
  options.stability = true;
  Stand stand(load_builtin(scene_name), options, largest_padding_texels(options.filters));
  const SceneTask task{&stand.scene, &stand.scene.cameras.front(), map_size, options.filters};
  return measure_scene({stand.renderer, stand.options, task, stand.assets}).cells;
}

class Defaults : public ::testing::TestWithParam<std::string> {};

TEST_P(Defaults, NothingBreaks) {
  for (const MeasuredCell& cell : measure(GetParam(), "")) {
    SCOPED_TRACE(cell.label);
    EXPECT_TRUE(std::all_of(cell.visibility.texels.begin(), cell.visibility.texels.end(),
                            [](float v) { return std::isfinite(v); }));
    EXPECT_EQ(cell.record.nan, 0);
    EXPECT_TRUE(cell.record.warnings.empty()) << cell.record.warnings.front();
    const records::StabilityRecord& s = cell.record.stability;
    EXPECT_EQ(s.overflow_texels.value_or(0), 0);
    EXPECT_EQ(s.nan_texels.value_or(0), 0);
    EXPECT_EQ(s.bound_violations.value_or(0), 0);
    EXPECT_EQ(s.bound_exact_violations.value_or(0), 0);
  }
}

INSTANTIATE_TEST_SUITE_P(Scenes, Defaults, ::testing::ValuesIn(builtin_scenes()));

/// The famous limits, on a map that the GL made: 11.09 in 16 bits and 88.72 in 32, over the largest depth, which is 1.
TEST(Stability, SafeExponents_AreTheTheoreticalOnes) {
  const auto cells = measure("cubes", "esm:c=2000,store=r16f,esm:c=8,store=r16f,esm:c=2000,esm:c=40,combine=log", 128);
  ASSERT_EQ(cells.size(), 4u);
  for (const std::size_t half : {0u, 1u}) EXPECT_NEAR(*cells[half].record.stability.safe_exponent, 11.09, 0.01 * 11.09);
  EXPECT_NEAR(*cells[2].record.stability.safe_exponent, 88.72, 0.001 * 88.72);
  EXPECT_FALSE(cells[3].record.stability.safe_exponent) << "logarithms do not overflow";
  EXPECT_GT(cells[0].record.stability.overflow_texels, 0);
  EXPECT_FALSE(cells[0].record.stability.headroom);
  EXPECT_NEAR(*cells[1].record.stability.headroom, 11.09 - 8.0, 0.01);
  EXPECT_EQ(cells[1].record.stability.overflow_texels, 0);
}

/// Counts and pictures say the same.
TEST(Stability, Images_HoldWhatIsCounted) {
  const auto cells = measure("stack", "vsm:store=rg16f,esm:c=20,store=r16f", 256);
  const auto count = [](const images::Image& image, auto&& is) {
    return std::count_if(image.texels.begin(), image.texels.end(), is);
  };
  const records::StabilityRecord &vsm = cells[0].record.stability, &esm = cells[1].record.stability;
  EXPECT_GT(vsm.negative_variance_texels, 0);
  EXPECT_EQ(count(
                cells[0].stability.variance, [](float v) { return v < 0.0f; }),
            *vsm.negative_variance_texels);
  EXPECT_EQ(count(cells[1].stability.headroom, [](float v) { return std::isinf(v) && v < 0.0f; }),
            *esm.overflow_texels);
  EXPECT_TRUE(cells[1].stability.variance.empty());
  EXPECT_GT(*esm.bound_violations, 0) << "an overflow is no rounding";
  EXPECT_GT(vsm.half_difference_max, 0.01);
  EXPECT_GT(count(cells[0].stability.half_difference, [](float v) { return std::abs(v) > 0.01f; }), 0);
}

/// The same whichever of the two stores the cell itself has.
TEST(Stability, HalfDifference_IsHalfLessSingle) {
  const auto cells = measure("stack", "vsm:store=rg16f,vsm:store=rg32f", 256);
  EXPECT_EQ(cells[0].record.stability.half_difference_max, cells[1].record.stability.half_difference_max);
  EXPECT_EQ(cells[0].stability.half_difference.texels, cells[1].stability.half_difference.texels);
  std::vector<float> difference = cells[0].visibility.texels;
  for (std::size_t i = 0; i < difference.size(); ++i) difference[i] -= cells[1].visibility.texels[i];
  EXPECT_EQ(cells[0].stability.half_difference.texels, difference);
}

/// Light-bleeding reduction gives the bound up, and says so; a filter that promises it still is held to it.
TEST(Stability, ReducedBleeding_IsNoBound) {
  const auto cells = measure("stack", "vsm,vsm:bleed_reduction=0,pcf2x2", 512);
  EXPECT_FALSE(cells[0].record.stability.bound_violations);
  EXPECT_EQ(cells[0].record.absent.at("stability.bound_violations"),
            "the filter is a bound with bleed_reduction=0 only");
  EXPECT_EQ(cells[1].record.stability.bound_violations, 0);
  EXPECT_FALSE(cells[2].record.stability.bound_violations);
  EXPECT_EQ(cells[2].record.absent.count("stability.bound_violations"), 1u);
}

}  // namespace
}  // namespace shadowbench::test
