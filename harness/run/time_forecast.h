#pragma once

#include <string>

#include "harness/measure/renderer.h"
#include "harness/options/work_meter.h"
#include "harness/run/run_plan.h"
#include "reference/truth/truth_cache.h"

namespace shadowbench::run {

/// Gives the seconds that a step presumably takes for one cell of a task, from the sizes of picture and map, the number
/// of cores, and what the cache has. What all cells of a task share is in equal parts in each.
double presume_cell_s(const PlannedScene& scene, const PlannedTask& task, options::Work kind);

/// The same of the report at the end.
double presume_report_s(const RunPlan& plan);

/// What is known of a run's time before it begins.
struct TimeForecast {
  double seconds = 0.0;
  std::string text;  ///< "; about 90 s: 16 s of timing, the rest ray tracing and images"
};

/// Forecasts the time of the cells that are left. For a fixed number of rounds it draws the first task's map and the
/// filter that the others are timed against, and counts texels and pixels of all. Throws Error(kUsage) when the GL
/// cannot give a map of the first size.
TimeForecast forecast_time(measure::Renderer& renderer, const RunPlan& plan, truth::TruthCache& cache);

}  // namespace shadowbench::run
