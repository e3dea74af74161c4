#pragma once

#include "harness/measure/renderer.h"
#include "harness/run/run_plan.h"
#include "reference/truth/truth_cache.h"

namespace shadowbench::run {

/// Says how long the timed work of a run takes at the least.
struct TimeFloor {
  double seconds = 0.0;
  bool whole =
      true;  ///< every view, picture and map was drawn; else those that were not count as the quickest that was
};

/// Draws each view and map of a plan whose rounds are fixed, with the filter that the others are timed against, which
/// is the quickest, and multiplies by rounds and cells. Prefilters and rounds that warm up are left out, and of the
/// cells of one view the map is counted once, so that the run takes longer. Requires fixed rounds. Throws Error(kUsage)
/// when the GL cannot give a map of a planned size. Cost: some 2 s at most beside one view's.
TimeFloor probe_time_floor(measure::Renderer& renderer, const RunPlan& plan, truth::TruthCache& cache);

}  // namespace shadowbench::run
