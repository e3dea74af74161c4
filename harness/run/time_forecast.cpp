#include "harness/run/time_forecast.h"

#include <fmt/format.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include "harness/measure/filter_setup.h"
#include "harness/measure/scene_assets.h"
#include "harness/render/filter_passes.h"
#include "report/records/format.h"

namespace shadowbench::run {
namespace {

using options::Work;

constexpr int kDrawn = 3;  // the first of them warms up

/// What a picture of any size costs, in pixels.
constexpr double kFixedMegapixels = 0.05;

/// Pictures that the page shows first, with many samples: so many as it has choices.
constexpr double kFirstPictures = 2.0;

double count_megapixels(const options::RunOptions& options) {
  return kFixedMegapixels + 1e-6 * options.width * options.height;
}

double count_megatexels(int map_size) { return 1e-6 * map_size * map_size; }

/// How many times as long work takes as on two cores; a third of it is done by one.
double scale_by_cores() { return 1.0 / 3.0 + 4.0 / 3.0 / tbb::this_task_arena::max_concurrency(); }

std::string describe_duration(double seconds) {
  if (seconds < 10.0) return records::format_number(seconds) + " s";
  const auto whole = static_cast<long>(std::ceil(seconds));
  if (whole < 60) return fmt::format("{} s", whole);
  if (whole < 3600) return fmt::format("{} min {} s", whole / 60, whole % 60);
  return fmt::format("{} h {} min", whole / 3600, whole % 3600 / 60);
}

/// Milliseconds of a round for each million texels of the map, and pixels of a lookup.
struct RoundRate {
  double map_ms = 0.0;
  double lookup_ms = 0.0;
};

double find_quickest_ms(gl::TimerKind timer, const std::function<void()>& work) {
  double quickest = std::numeric_limits<double>::infinity();
  for (int i = 0; i < kDrawn; ++i) quickest = std::min(quickest, gl::time_ms(timer, work));
  return quickest;
}

RoundRate draw_round(measure::Renderer& renderer, const PlannedScene& planned, const measure::SceneTask& task,
                     truth::TruthCache& cache) {
  const options::RunOptions& options = planned.options;
  measure::SceneAssets assets(renderer, options, planned.scene, cache, measure::padding_texels(options));
  measure::LightMap& light = assets.light_map(*task.camera, task.map_size);
  render::GBuffer& gbuffer = assets.gbuffer(*task.camera);
  const auto reference = measure::make_filter_passes(renderer, options, planned.scene, light, options.reference);
  render::ImageTarget target("timed visibility", GL_R32F, options.width, options.height);
  const double map_ms = find_quickest_ms(
      renderer.timer, [&] { assets.redraw(light); });
  const double lookup_ms = find_quickest_ms(renderer.timer, [&] { reference->lookup(gbuffer, light.map, target); });
  return {map_ms / count_megatexels(task.map_size), lookup_ms / count_megapixels(options)};
}

/// Pictures that are drawn soon are precise soon, unless a larger budget says that they are to be more so.
double presume_timing_s(const options::RunOptions& options, double draw_s) {
  if (options.rounds.is_fixed()) return 0.1 * draw_s * options.rounds.most;
  const double budget_s = 1e-3 * options.rounds.budget_ms;
  const bool is_told_more = options.rounds.budget_ms > options::RoundLimits().budget_ms;
  return is_told_more ? budget_s : std::min(budget_s, 15.0 * draw_s);
}

double forecast_timing_s(measure::Renderer& renderer, const RunPlan& plan, truth::TruthCache& cache) {
  double seconds = 0.0;
  std::optional<RoundRate> rate;
  for (const PlannedTask& task : plan.tasks) {
    const PlannedScene& planned = plan.scenes[task.scene];
    const auto cells = static_cast<double>(task.task.filters.size());
    if (cells == 0.0) continue;
    if (!planned.options.rounds.is_fixed()) {
      seconds += cells * presume_cell_s(planned, task, Work::kTiming);
      continue;
    }
    if (!rate) rate = draw_round(renderer, planned, task.task, cache);
    seconds += 1e-3 * planned.options.rounds.most *
               (count_megatexels(task.task.map_size) * rate->map_ms +
                cells * count_megapixels(planned.options) * rate->lookup_ms);
  }
  return seconds;
}

}  // namespace

/// Measured in quiet processor seconds of the default run: each kind's time in its busiest thread, or half of all.
double presume_cell_s(const PlannedScene& scene, const PlannedTask& task, Work kind) {
  const options::RunOptions& options = scene.options;
  const double megapixels = count_megapixels(options), megatexels = count_megatexels(task.task.map_size);
  const double draw_s = 0.06 * megapixels + 0.02 * megatexels;  // prefilter, lookup, and what is read back
  const double of_task = 1.0 / static_cast<double>(std::max<std::size_t>(task.task.filters.size(), 1));
  const double to_trace = !options.truth ? 0.0 : task.is_traced ? 0.45 : 1.0;
  const double cores = scale_by_cores();
  const double compile_s = task.is_traced ? 0.035 : 0.07;  // for each GPU, once: all scenes have the same passes
  switch (kind) {
    case Work::kDrawing:
      return cores * (draw_s + (options.stability ? megapixels : 0.0) + (options.uncertainty ? 2.0 * megapixels : 0.0));
    case Work::kTiming: return presume_timing_s(options, draw_s);
    case Work::kPhases: return cores * 0.5 * draw_s * (options.phases - 1);
    case Work::kTruth: return cores * 0.65 * megapixels * of_task * to_trace;
    case Work::kScores: return options.truth ? cores * 0.11 * megapixels : 0.0;
    case Work::kSurroundings: return cores * 0.73 * megapixels * of_task * to_trace;
    case Work::kAttribution: return options.attribution ? cores * 0.36 * megapixels * to_trace : 0.0;
    case Work::kGpus:
      if (options.gpus.empty()) return 0.0;
      return 0.33 * megapixels + (task.scene > 0 ? 0.0 : compile_s * static_cast<double>(options.gpus.size()));
    case Work::kFrames: return options.frames > 1 ? cores * megapixels * (4.0 + 0.2 * options.frames) : 0.0;
    case Work::kPictures: return options.pictures ? cores * 0.15 * megapixels : 0.0;
    case Work::kReport: return 0.0;
  }
  return 0.0;
}

double presume_report_s(const RunPlan& plan) {
  const options::RunOptions& options = plan.scenes.front().options;
  const bool has_first_pictures = options.pictures && options.truth;
  return 0.02 * plan.own_cells +
         (has_first_pictures ? scale_by_cores() * kFirstPictures * 2.3 * count_megapixels(options) : 0.0);
}

TimeForecast forecast_time(measure::Renderer& renderer, const RunPlan& plan, truth::TruthCache& cache) {
  const double timing_s = forecast_timing_s(renderer, plan, cache);
  double seconds = timing_s + presume_report_s(plan);
  for (const PlannedTask& task : plan.tasks)
    for (std::size_t kind = 0; kind < options::kWorks; ++kind)
      if (static_cast<Work>(kind) != Work::kTiming)
        seconds += static_cast<double>(task.task.filters.size()) *
                   presume_cell_s(plan.scenes[task.scene], task, static_cast<Work>(kind));
  return {seconds,
          fmt::format("; about {}: {} of timing, the rest {}", describe_duration(seconds), describe_duration(timing_s),
                      plan.scenes.front().options.truth ? "ray tracing and images" : "images")};
}

}  // namespace shadowbench::run
