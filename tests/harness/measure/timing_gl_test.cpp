#include "harness/measure/timing.h"
#include "tests/harness/render/bench_fixture.h"

namespace shadowbench::test {
namespace {

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
