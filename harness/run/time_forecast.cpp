#include "harness/run/time_forecast.h"

#include <fmt/format.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>

#include "report/records/format.h"

namespace shadowbench::run {
namespace {

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

/// Of prefilter, lookup, and what is read back.
double presume_drawing_s(const PlannedScene& scene, const PlannedTask& task) {
  return 0.06 * count_megapixels(scene.options) + 0.02 * count_megatexels(task.task.map_size);
}

}  // namespace

/// Pictures that are drawn soon are precise soon, unless a larger budget says that they are to be more so.
double presume_timing_s(const PlannedScene& scene, const PlannedTask& task) {
  const options::RunOptions& options = scene.options;
  const double draw_s = presume_drawing_s(scene, task), cells = static_cast<double>(task.task.filters.size());
  if (options.rounds.is_fixed()) return cells * 0.1 * draw_s * options.rounds.most;
  const double budget_s = 1e-3 * options.rounds.budget_ms;
  const bool is_told_more = options.rounds.budget_ms > options::RoundLimits().budget_ms;
  return cells * (is_told_more ? budget_s : std::min(budget_s, 15.0 * draw_s));
}

/// Measured in quiet processor seconds of the default run: each kind's time in its busiest thread, or half of all.
double presume_task_s(const PlannedScene& scene, const PlannedTask& task) {
  const options::RunOptions& options = scene.options;
  const auto cells = static_cast<double>(task.task.filters.size());
  if (cells == 0.0) return 0.0;
  const double megapixels = count_megapixels(options), draw_s = presume_drawing_s(scene, task);
  const double cores = scale_by_cores(), to_trace = !options.truth ? 0.0 : task.is_traced ? 0.45 : 1.0;
  const double compile_s = task.is_traced ? 0.035 : 0.07;  // for each GPU, once: all scenes have the same passes
  double of_pixels = 0.0, gpus_s = 0.0;                    // seconds a cell
  if (options.stability) of_pixels += 1.0;
  if (options.uncertainty) of_pixels += 2.0;
  if (options.truth) of_pixels += 0.11;
  if (options.attribution) of_pixels += 0.36 * to_trace;
  if (options.frames > 1) of_pixels += 4.0 + 0.2 * options.frames;
  if (options.pictures) of_pixels += 0.15;
  if (!options.gpus.empty())
    gpus_s = 0.33 * megapixels + (task.scene > 0 ? 0.0 : compile_s * static_cast<double>(options.gpus.size()));
  const double cell_s = cores * (draw_s * (1.0 + 0.5 * (options.phases - 1)) + of_pixels * megapixels) + gpus_s;
  return cells * cell_s + cores * 1.15 * megapixels * to_trace;  // truth, and what surrounds its receivers
}

double presume_report_s(const RunPlan& plan) {
  const options::RunOptions& options = plan.scenes.front().options;
  const bool has_first_pictures = options.pictures && options.truth;
  return 0.02 * plan.own_cells +
         (has_first_pictures ? scale_by_cores() * kFirstPictures * 1.2 * count_megapixels(options) : 0.0);
}

TimeForecast forecast_time(const RunPlan& plan) {
  double timing_s = 0.0, seconds = presume_report_s(plan);
  for (const PlannedTask& task : plan.tasks) {
    timing_s += presume_timing_s(plan.scenes[task.scene], task);
    seconds += presume_task_s(plan.scenes[task.scene], task);
  }
  seconds += timing_s;
  return {seconds,
          fmt::format("; about {}: {} of timing, the rest {}", describe_duration(seconds), describe_duration(timing_s),
                      plan.scenes.front().options.truth ? "ray tracing and images" : "images")};
}

}  // namespace shadowbench::run
