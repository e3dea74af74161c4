#pragma once

#include <string>

#include "harness/measure/renderer.h"
#include "harness/run/run_plan.h"
#include "reference/truth/truth_cache.h"

namespace shadowbench::run {

/// What is known of a run's time before it begins.
struct TimeForecast {
  double seconds = 0.0;  ///< of timed work
  std::string text;
};

/// Forecasts the timed work of the cells that are left, so many; the progress bar counts rays and pictures in once the
/// first are made. For a fixed number of rounds it draws each view and map of the plan with the filter that the others
/// are timed against, which is the quickest, and multiplies by rounds and cells. The run takes longer: prefilters and
/// rounds that warm up are left out, and the map is counted once for all cells of a view. Throws Error(kUsage) when the
/// GL cannot give a map of a planned size. Cost: some 2 s at most beside one view's.
TimeForecast forecast_time(measure::Renderer& renderer, const RunPlan& plan, truth::TruthCache& cache, int left);

}  // namespace shadowbench::run
