#pragma once

#include "harness/measure/scene_measurement.h"
#include "harness/render/filter_passes.h"

namespace shadowbench::measure {

/// What a cell was drawn with.
struct DrawnTask {
  Renderer& renderer;
  const options::RunOptions& options;
  const SceneTask& task;
  SceneAssets& assets;
};

/// Leaves in the cell how far rounding can move each pixel (filters with a scalar model), and how far other seeds move
/// it (stochastic filters). Requires that the filter's map was made; its passes are turned back to the run's own seed.
/// Cost: the scalar model with its running error bound for every receiver, and images::kSpreadSeeds lookups.
void measure_uncertainty(const DrawnTask& drawn, MeasuredCell& cell, render::FilterPasses& filter);

}  // namespace shadowbench::measure
