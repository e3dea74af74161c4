#include "harness/run/time_forecast.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <functional>
#include <limits>
#include <optional>

#include "harness/measure/filter_setup.h"
#include "harness/measure/scene_assets.h"
#include "harness/render/filter_passes.h"
#include "report/records/format.h"

namespace shadowbench::run {
namespace {

constexpr double kMostDrawing_s = 2.0;
constexpr int kDrawn = 3;  // the first of them warms up

std::string describe_duration(double seconds) {
  if (seconds < 10.0) return records::format_number(seconds) + " s";
  const auto whole = static_cast<long>(std::ceil(seconds));
  if (whole < 60) return fmt::format("{} s", whole);
  if (whole < 3600) return fmt::format("{} min {} s", whole / 60, whole % 60);
  return fmt::format("{} h {} min", whole / 3600, whole % 3600 / 60);
}

/// What a round of one view through one map takes.
struct RoundTime {
  double map_ms = 0.0;
  double lookup_ms = 0.0;

  double of_cells_ms(std::size_t cells) const { return map_ms + static_cast<double>(cells) * lookup_ms; }
};

double find_quickest_ms(gl::TimerKind timer, const std::function<void()>& work) {
  double quickest = std::numeric_limits<double>::infinity();
  for (int i = 0; i < kDrawn; ++i) quickest = std::min(quickest, gl::time_ms(timer, work));
  return quickest;
}

RoundTime draw_round(measure::Renderer& renderer, const PlannedScene& planned, const measure::SceneTask& task,
                     measure::SceneAssets& assets) {
  const options::RunOptions& options = planned.options;
  measure::LightMap& light = assets.light_map(*task.camera, task.map_size);
  render::GBuffer& gbuffer = assets.gbuffer(*task.camera);
  const auto reference = measure::make_filter_passes(renderer, options, planned.scene, light, options.reference);
  render::ImageTarget target("timed visibility", GL_R32F, options.width, options.height);
  return {find_quickest_ms(renderer.timer, [&] { assets.redraw(light); }),
          find_quickest_ms(renderer.timer, [&] { reference->lookup(gbuffer, light.map, target); })};
}

/// The least time that timed work takes, in seconds.
struct TimeFloor {
  double seconds = 0.0;
  bool whole = true;  ///< false: not every view and map was drawn, and those left count as the quickest that was
};

/// Draws the planned tasks scene by scene until that has taken long enough.
class FloorMeter {
 public:
  FloorMeter(measure::Renderer& renderer, const RunPlan& plan, truth::TruthCache& cache)
      : renderer_(renderer), plan_(plan), cache_(cache) {}

  TimeFloor run() {
    for (std::size_t scene = 0; scene < plan_.scenes.size(); ++scene) add_scene(scene);
    TimeFloor floor{1e-3 * drawn_ms_, left_cells_ == 0};
    if (!floor.whole) floor.seconds += 1e-3 * static_cast<double>(rounds()) * quickest_.of_cells_ms(left_cells_);
    return floor;
  }

 private:
  using Clock = std::chrono::steady_clock;

  measure::Renderer& renderer_;
  const RunPlan& plan_;
  truth::TruthCache& cache_;
  Clock::time_point start_ = Clock::now();
  double drawn_ms_ = 0.0;
  std::size_t left_cells_ = 0;
  RoundTime quickest_{0.0, std::numeric_limits<double>::infinity()};

  int rounds() const { return plan_.scenes.front().options.rounds.most; }

  bool is_time_left() const {
    return std::chrono::duration<double>(Clock::now() - start_).count() < kMostDrawing_s || drawn_ms_ == 0.0;
  }

  void add_scene(std::size_t scene) {
    const PlannedScene& planned = plan_.scenes[scene];
    const options::RunOptions& options = planned.options;
    std::optional<measure::SceneAssets> assets;
    for (const PlannedTask& each : plan_.tasks) {
      if (each.scene != scene || each.task.filters.empty()) continue;
      if (!is_time_left()) {
        left_cells_ += each.task.filters.size();
        continue;
      }
      if (!assets) assets.emplace(renderer_, options, planned.scene, cache_, measure::padding_texels(options));
      const RoundTime round = draw_round(renderer_, planned, each.task, *assets);
      drawn_ms_ += rounds() * round.of_cells_ms(each.task.filters.size());
      if (round.lookup_ms < quickest_.lookup_ms) quickest_ = {0.0, round.lookup_ms};
    }
  }
};

}  // namespace

TimeForecast forecast_time(measure::Renderer& renderer, const RunPlan& plan, truth::TruthCache& cache, int left) {
  const options::RunOptions& options = plan.scenes.front().options;
  const char* on_top = options.truth ? "rays and pictures come on top" : "pictures come on top";
  if (!options.rounds.is_fixed()) {
    const double timings = 1.0 + static_cast<double>(options.lights.size());
    const double seconds = left * timings * 1e-3 * options.rounds.budget_ms;
    return {seconds, fmt::format("; {} of timed work at most, more where four rounds take longer; {}",
                                 describe_duration(seconds), on_top)};
  }
  const TimeFloor floor = FloorMeter(renderer, plan, cache).run();
  return {floor.seconds, fmt::format("; {} {} of timed work, what --rounds {} of the unfiltered lookup take; {}",
                                     floor.whole ? "at least" : "about", describe_duration(floor.seconds),
                                     options.rounds.most, on_top)};
}

}  // namespace shadowbench::run
