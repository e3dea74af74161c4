#include <cmath>

#include "filters/front_matter.h"
#include "harness/measure/scene_assets.h"
#include "harness/measure/timing.h"
#include "reference/truth/cached_tracer.h"
#include "tests/harness/render/bench_fixture.h"

namespace shadowbench::test {
namespace {

constexpr int kMapSize = 512;

/// A small scene to time filters in.
class Timed {
 public:
  Timed()
      : scene_(load_builtin("cubes")),
        renderer_(measure::make_renderer(gl::Backend::kAuto, options::find_resources())),
        cache_({}, [](const std::string&) {}),
        assets_(renderer_, options_, scene_, cache_, 6.0) {}

  /// The own time of a filter, as records hold it.
  records::OwnTime time(const filters::FilterRequest& request) {
    const scene::Camera& camera = scene_.cameras.front();
    measure::LightMap& map = assets_.light_map(camera, kMapSize);
    const auto passes = measure::make_filter_passes(renderer_, options_, scene_, map, request);
    render::ImageTarget target("visibility", GL_R32F, options_.width, options_.height);
    measure::draw_visibility(*passes, map.map, assets_.gbuffer(camera), target);
    const std::vector<render::FilterPasses*> filters = {passes.get()};
    const auto empty = measure::make_empty_lookups(renderer_, options_, scene_, map, filters);
    const measure::RoundTimes times = measure::time_rounds({.filters = filters,
                                                            .empties = empty.passes,
                                                            .draw_map = [&] { assets_.redraw(map); },
                                                            .map = map.map,
                                                            .gbuffer = assets_.gbuffer(camera),
                                                            .timer = renderer_.timer},
                                                           {.limits = options::RoundLimits::exactly(40)});
    return measure::find_difference(times.filters[0].lookup, times.empties[0]);
  }

 private:
  scene::Scene scene_;
  options::RunOptions options_ = make_options();
  measure::Renderer renderer_;
  truth::TruthCache cache_;
  measure::SceneAssets assets_;

  static options::RunOptions make_options() {
    options::RunOptions options;
    options.width = 320;
    options.height = 180;
    return options;
  }
};

/// A filter of the user's that returns this expression.
filters::FilterRequest make_filter(const std::string& expression) {
  filters::FilterRequest request;
  request.spec = filters::parse_filter(
      "/*+++\ntitle = \"t\"\nsource = \"s\"\nkind = \"other\"\n+++*/\n"
      "float visibility(Receiver r) { return " +
          expression + "; }\n",
      "test.glsl");
  return request;
}

// A 95 % interval misses now and then: of three, one must hold 0.
TEST(OwnTime, OfAConstantIsNothing) {
  Timed timed;
  bool holds_nothing = false;
  for (int attempt = 0; attempt < 3 && !holds_nothing; ++attempt) {
    const records::OwnTime time = timed.time(make_filter("0.5"));
    std::printf("constant: %.4f ms [%.4f, %.4f]\n", time.median, time.ci95.low, time.ci95.high);
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
  const scene::Scene scene = load_builtin("cubes");
  Bench bench(shared_context(), scene, 512, 480, 270);
  const auto requests = catalogue().parse_requests("none,poisson:taps=16,poisson:taps=32");
  std::vector<std::unique_ptr<render::FilterPasses>> filters;
  std::vector<render::FilterPasses*> pointers;
  for (const auto& request : requests) {
    filters.push_back(
        std::make_unique<render::FilterPasses>(bench.shaders(), request, bench.map(), bench.light(request)));
    pointers.push_back(filters.back().get());
  }
  const gl::TimerKind timer = gl::choose_timer(shared_context());
  const measure::RoundTimes times =
      measure::time_rounds({.filters = pointers, .map = bench.map(), .gbuffer = bench.gbuffer(), .timer = timer},
                           {.limits = options::RoundLimits::exactly(31)});
  const records::Ratio ratio = measure::find_ratio(times.filters[2].lookup, times.filters[1].lookup);
  std::printf("32 taps / 16 taps: %.2f [%.2f, %.2f] by %s\n", ratio.median, ratio.ci95.low, ratio.ci95.high,
              gl::timer_name(timer));
  EXPECT_EQ(times.map.size(), 31u);
  EXPECT_TRUE(times.filters[0].prefilter.empty());
  // The lookup is most of the pass; a clock that times the queueing would read about 1.
  EXPECT_GT(ratio.median, 1.3);
}

}  // namespace
}  // namespace shadowbench::test
