#pragma once

#include "harness/options/options.h"
#include "harness/run/run_plan.h"

namespace shadowbench::run {

/// Draws what the lights of a scene make of it together, which a run measures one by one: for each view and map
/// settings a grid with the truth and each filter, summed from the pictures in the lights' EXR files, with the frame's
/// cost. The picture's path goes into the cells' records. A group whose files are not all there, as in a shard, gets
/// none. Throws Error(kOutput).
void draw_all_lights(const options::RunOptions& options, const RunPlan& plan, const records::GlRecord& gl);

}  // namespace shadowbench::run
