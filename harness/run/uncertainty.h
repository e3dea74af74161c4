#pragma once

#include "harness/render/filter_passes.h"
#include "harness/run/scene_measurement.h"

namespace shadowbench::run {

/// What a cell was drawn with.
struct DrawnTask {
  Renderer& renderer;
  const RunOptions& options;
  const SceneTask& task;
  SceneAssets& assets;
};

/// Leaves in the cell how far rounding can move each pixel (filters with a scalar model), and how far other seeds move
/// it (stochastic filters). Requires that the filter's map was made; its passes are turned back to the run's own seed.
/// Cost: the scalar model with its running error bound for every receiver, and report::kSpreadSeeds lookups.
void measure_uncertainty(const DrawnTask& drawn, MeasuredCell& cell, render::FilterPasses& filter);

}  // namespace shadowbench::run
