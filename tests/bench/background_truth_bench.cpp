// What truth in the background costs the window, and what the window's waiting costs the truth.

#include <benchmark/benchmark.h>
#include <time.h>

#include <algorithm>
#include <chrono>
#include <thread>
#include <vector>

#include "harness/gl/context/context.h"
#include "harness/options/options.h"
#include "harness/render/shader_library.h"
#include "harness/scene/load.h"
#include "harness/scene/scene.h"
#include "harness/view/background_truth.h"
#include "tests/bench/median.h"

namespace shadowbench::bench {
namespace {

using Clock = std::chrono::steady_clock;

double ms_since(Clock::time_point begin) {
  return std::chrono::duration<double, std::milli>(Clock::now() - begin).count();
}

double computed_ms(clockid_t clock) {
  timespec time{};
  clock_gettime(clock, &time);
  return 1e3 * static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_nsec);
}

/// What the first camera of a scene sees in 960 x 540, and what traces it. Nothing is kept.
struct TracedView {
  explicit TracedView(const std::string& name)
      : scene(scene::load(name, {.scenes_folder = options::find_resources().scenes})) {
    static gl::ContextChoice choice = gl::create_context(gl::Backend::kAuto);
    render::ShaderLibrary shaders(options::find_resources().shaders);
    render::GBuffer gbuffer(960, 540);
    gbuffer.draw(shaders, render::Geometry(scene), scene, scene.cameras.front());
    surfaces = std::make_shared<measure::ViewSurfaces>(measure::read_view_surfaces(gbuffer));
  }

  truth::CachedTracer::MeshList list_meshes() const {
    return [this] { return scene::list_occluders(scene); };
  }
  view::TruthJob job() const { return {surfaces, scene.light}; }

  /// Waits until there is what `is_enough`.
  template <class IsEnough>
  static void wait(view::BackgroundTruth& background, IsEnough is_enough) {
    for (;;) {
      const auto shown = background.take();
      if (shown && is_enough(*shown)) return;
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
  }
  static bool is_first(const view::BackgroundTruth::Shown& shown) { return !shown.visibility.empty(); }
  static bool is_last(const view::BackgroundTruth::Shown& shown) { return shown.truth != nullptr; }

  scene::Scene scene;
  std::shared_ptr<const measure::ViewSurfaces> surfaces;
  truth::TruthCache none{{}, {}};
};

/// The same view traced by a run and in the background, in turns, acceleration structure and all.
void background_truth(benchmark::State& state, const char* scene) {
  TracedView view(scene);
  std::vector<double> plain, first, full, ratios, starts, processor_ratios;
  for (auto _ : state) {
    for (int round = 0; round < 11; ++round) {
      double processor = computed_ms(CLOCK_PROCESS_CPUTIME_ID);
      auto begin = Clock::now();
      truth::CachedTracer tracer(view.list_meshes(), view.none, 1);
      measure::trace_scene(tracer, view.scene.light, measure::make_view_receivers(*view.surfaces, view.scene.light));
      plain.push_back(ms_since(begin));
      const double plain_processor = computed_ms(CLOCK_PROCESS_CPUTIME_ID) - processor;
      view::BackgroundTruth background(view.list_meshes(), view.none, 1);
      processor = computed_ms(CLOCK_PROCESS_CPUTIME_ID);
      begin = Clock::now();
      background.start(view.job());
      starts.push_back(ms_since(begin));
      TracedView::wait(background, &TracedView::is_first);
      first.push_back(ms_since(begin));
      TracedView::wait(background, &TracedView::is_last);
      full.push_back(ms_since(begin));
      processor_ratios.push_back((computed_ms(CLOCK_PROCESS_CPUTIME_ID) - processor) / plain_processor);
      ratios.push_back(full.back() / plain.back());
    }
  }
  state.counters["plain_ms"] = median(plain);
  state.counters["first_picture_ms"] = median(first);
  state.counters["full_ms"] = median(full);
  state.counters["full_over_plain"] = median(ratios);
  state.counters["processor_over_plain"] = median(processor_ratios);
  state.counters["longest_start_ms"] = std::ranges::max(starts);
}
BENCHMARK_CAPTURE(background_truth, cubes, "cubes")->Iterations(1);
BENCHMARK_CAPTURE(background_truth, fence, "fence")->Iterations(1);
BENCHMARK_CAPTURE(background_truth, ball, "ball")->Iterations(1);

/// How long after stop() threads still compute, at 20 moments of a trace.
void stop_of_truth(benchmark::State& state, const char* scene) {
  TracedView view(scene);
  view::BackgroundTruth background(view.list_meshes(), view.none, 1);
  std::vector<double> ends;
  for (auto _ : state) {
    for (int moment = 0; moment < 20; ++moment) {
      background.start(view.job());
      TracedView::wait(background, &TracedView::is_first);
      std::this_thread::sleep_for(std::chrono::milliseconds(5 + 7 * moment));
      const auto others = [] { return computed_ms(CLOCK_PROCESS_CPUTIME_ID) - computed_ms(CLOCK_THREAD_CPUTIME_ID); };
      const auto begin = Clock::now();
      background.stop();
      double end = 0.0, computed = others();
      while (ms_since(begin) < end + 50.0) {
        std::this_thread::sleep_for(std::chrono::microseconds(200));
        if (others() < computed + 0.02) continue;
        end = ms_since(begin);
        computed = others();
      }
      ends.push_back(end);
    }
  }
  state.counters["median_ms"] = median(ends);
  state.counters["longest_ms"] = std::ranges::max(ends);
}
BENCHMARK_CAPTURE(stop_of_truth, cubes, "cubes")->Iterations(1);

/// How late work of 5 ms is done that falls due every 20 ms, for 10 s.
std::vector<double> measure_lateness() {
  std::vector<double> late;
  const auto begin = Clock::now();
  for (auto due = begin; due < begin + std::chrono::seconds(10); due += std::chrono::milliseconds(20)) {
    std::this_thread::sleep_until(due);
    const double end = computed_ms(CLOCK_THREAD_CPUTIME_ID) + 5.0;
    while (computed_ms(CLOCK_THREAD_CPUTIME_ID) < end) continue;
    late.push_back(ms_since(due));
  }
  return late;
}

/// A window's work while nothing else goes on, while truth is traced in the background, and while a run traces it.
void window_beside_truth(benchmark::State& state, const char* scene) {
  TracedView view(scene);
  const auto note = [&](const std::string& what) {
    const std::vector<double> late = measure_lateness();
    state.counters[what + "_median_ms"] = median(late);
    state.counters[what + "_longest_ms"] = std::ranges::max(late);
  };
  for (auto _ : state) {
    note("alone");
    {
      view::BackgroundTruth background(view.list_meshes(), view.none, 1);
      std::jthread again([&](const std::stop_token& stop) {
        while (!stop.stop_requested()) {
          background.start(view.job());
          TracedView::wait(background, [&](const auto& shown) { return stop.stop_requested() || shown.truth; });
        }
      });
      note("background");
    }
    std::jthread run([&](const std::stop_token& stop) {
      truth::CachedTracer tracer(view.list_meshes(), view.none, 1);
      while (!stop.stop_requested())
        measure::trace_scene(tracer, view.scene.light, measure::make_view_receivers(*view.surfaces, view.scene.light));
    });
    note("run");
  }
}
BENCHMARK_CAPTURE(window_beside_truth, cubes, "cubes")->Iterations(1);

}  // namespace
}  // namespace shadowbench::bench
