#pragma once

#include <string>

#include "harness/run/run_plan.h"

namespace shadowbench::run {

/// Gives the seconds that the cells of a task presumably take but for their timing, from the sizes of picture and map,
/// the number of cores, and what the cache has.
double presume_task_s(const PlannedScene& scene, const PlannedTask& task);

/// The same of their timing.
double presume_timing_s(const PlannedScene& scene, const PlannedTask& task);

/// The same of the report at the end.
double presume_report_s(const RunPlan& plan);

/// What is known of a run's time before it begins.
struct TimeForecast {
  double seconds = 0.0;
  std::string text;  ///< "; about 90 s: 16 s of timing, the rest ray tracing and images"
};

/// Forecasts the time of the cells that are left.
TimeForecast forecast_time(const RunPlan& plan);

}  // namespace shadowbench::run
