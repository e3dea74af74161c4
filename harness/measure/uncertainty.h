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

/// Measures how far rounding can move each pixel (filters with a scalar model), and how far other seeds move it
/// (stochastic filters). Requires that the filter's map was made. The passes keep the run's own seed. Cost: the scalar
/// model with its running error bound for every receiver, and images::kSpreadSeeds lookups.
images::UncertaintyImages measure_uncertainty(const DrawnTask& drawn, render::FilterPasses& filter);

}  // namespace shadowbench::measure
