#pragma once

#include "harness/measure/renderer.h"
#include "harness/run/run_plan.h"
#include "reference/truth/truth_cache.h"

namespace shadowbench::run {

/// The least time that the timed work of a run takes.
struct TimeFloor {
  double seconds = 0.0;
  bool whole = true;  ///< false: not every view and map was drawn, and those left count as the quickest that was
};

/// Draws each view and map of a plan with the filter that the others are timed against, which is the quickest, and
/// multiplies by rounds and cells. The run takes longer: prefilters and rounds that warm up are left out, and the map
/// is counted once for all cells of a view. Requires fixed rounds. Throws Error(kUsage) when the GL cannot give a map
/// of a planned size. Cost: some 2 s at most beside one view's.
TimeFloor measure_time_floor(measure::Renderer& renderer, const RunPlan& plan, truth::TruthCache& cache);

}  // namespace shadowbench::run
