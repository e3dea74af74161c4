#pragma once

#include "harness/measure/scene_measurement.h"
#include "harness/measure/scene_truth.h"
#include "harness/render/filter_passes.h"

namespace shadowbench::measure {

// A wrong filter gets a score like any other. These checks mark its cell: the status is `suspect`, and a warning says
// what was found and what to do. Its pictures and errors stay.

/// Checks what needs no truth: that visibility is finite and in [0,1], that the filter reads the map, no farther than
/// it declares, and nothing that nobody wrote. Requires the cell's `nan`.
void check_drawing(MeasuredCell& cell, gl::Context& context);

/// Checks that visibility is not the same at all receivers where some are wholly lit in truth, and some wholly blocked.
void check_against_truth(MeasuredCell& cell, const SceneTruth& truth);

}  // namespace shadowbench::measure
