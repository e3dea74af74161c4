// What lookups cost beside each other, in interleaved rounds of one run.

#include <benchmark/benchmark.h>

#include <memory>

#include "harness/measure/timing.h"
#include "harness/options/options.h"
#include "harness/render/bias.h"
#include "harness/scene/load.h"

namespace shadowbench::bench {
namespace {

constexpr int kMapSize = 1024;

/// The `cubes` scene at the default run's size, with the filters of a request list.
class LookupBench {
 public:
  /// Each filter with each bias.
  explicit LookupBench(const std::string& filters, const std::vector<render::BiasRule>& rules = {{}})
      : resources_(options::find_resources()),
        choice_(gl::create_context(gl::Backend::kAuto)),
        timer_(gl::choose_timer(*choice_.context)),
        scene_(scene::load("cubes", {.scenes_folder = resources_.scenes})),
        shaders_(resources_.shaders),
        geometry_(scene_),
        frustum_(scene::fit_light(scene_, scene::FitMode::kTight, kMapSize, 6.0)),
        map_(kMapSize),
        gbuffer_(960, 540) {
    map_.draw(shaders_, geometry_, frustum_);
    gbuffer_.draw(shaders_, geometry_, scene_, scene_.cameras.front());
    filters::Catalogue catalogue(resources_.filters);
    catalogue.add_user_file(SHADOWBENCH_SOURCE_DIR "/tests/user_filters/nine_compares.glsl");
    for (const auto& request : catalogue.parse_requests(filters)) {
      for (const render::BiasRule& rule : rules) {
        const auto bias = render::resolve_bias(rule, frustum_, request.spec, request.values);
        const auto light = render::make_light_setup(frustum_, scene_.light, bias, 1);
        filters_.push_back(std::make_unique<render::FilterPasses>(shaders_, request, map_, light));
      }
    }
  }

  measure::RoundTimes time(int rounds) {
    std::vector<render::FilterPasses*> pointers;
    for (const auto& filter : filters_) pointers.push_back(filter.get());
    return measure::time_rounds({.filters = pointers, .map = map_, .gbuffer = gbuffer_, .timer = timer_},
                                {.limits = options::RoundLimits::exactly(rounds)});
  }

 private:
  options::Resources resources_;
  gl::ContextChoice choice_;
  gl::TimerKind timer_;
  scene::Scene scene_;
  render::ShaderLibrary shaders_;
  render::Geometry geometry_;
  scene::LightFrustum frustum_;
  render::ShadowMap map_;
  render::GBuffer gbuffer_;
  std::vector<std::unique_ptr<render::FilterPasses>> filters_;
};

/// Compares the first lookup with the second: their ratio with its interval, and both medians.
void compare(benchmark::State& state, LookupBench& bench) {
  measure::RoundTimes times;
  for (auto _ : state) times = bench.time(41);
  const records::Ratio ratio = measure::find_ratio(times.filters[0].lookup, times.filters[1].lookup);
  state.counters["ratio"] = ratio.median;
  state.counters["ratio_low"] = ratio.ci95.low;
  state.counters["ratio_high"] = ratio.ci95.high;
  state.counters["first_ms"] = measure::summarise(times.filters[0].lookup).median;
  state.counters["second_ms"] = measure::summarise(times.filters[1].lookup).median;
}

void compare_lookups(benchmark::State& state, const std::string& filters) {
  LookupBench bench(filters);
  compare(state, bench);
}

/// A filter with the receiver plane's depth at every tap, to the same filter with the default bias.
void receiver_plane(benchmark::State& state, const std::string& filter) {
  LookupBench bench(filter, {render::parse_bias({"receiver-plane"}), {}});
  compare(state, bench);
}

BENCHMARK_CAPTURE(receiver_plane, none, "none")->Iterations(1)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(receiver_plane, pcf2x2, "pcf2x2")->Iterations(1)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(receiver_plane, tent3x3, "tent3x3")->Iterations(1)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(receiver_plane, box3x3, "box3x3")->Iterations(1)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(receiver_plane, poisson, "poisson")->Iterations(1)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(compare_lookups, pcf2x2_to_none, "pcf2x2,none")->Iterations(1)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(compare_lookups, tent3x3_to_nine_compares, "tent3x3,nine_compares")
    ->Iterations(1)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(compare_lookups, vsm_to_none, "vsm,none")->Iterations(1)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(compare_lookups, poisson32_to_poisson16, "poisson:taps=32,poisson:taps=16")
    ->Iterations(1)
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace shadowbench::bench
