#pragma once

#include <vector>

#include "harness/measure/scene_assets.h"
#include "harness/options/options.h"
#include "harness/run/run_plan.h"
#include "reference/truth/cached_tracer.h"
#include "report/records/records.h"

namespace shadowbench::run {

/// Draws what the lights of a scene make of it together, which a run measures one by one: for each view and map
/// settings a grid with the truth and each filter, summed from the pictures in the lights' EXR files, with the frame's
/// cost. The picture's path goes into the cells' records. A group whose files are not all there, as in a shard, gets
/// none. Throws Error(kOutput).
void draw_all_lights(const options::RunOptions& options, const RunPlan& plan, const records::GlRecord& gl);

/// Draws what the run's page shows first once more with 16 samples a pixel, 4 of a large part, and the truth with as
/// many: every sample is a receiver of its own, looked up in the map that was measured, and shaded; their mean in
/// linear light is the pixel. The rest of the picture is as it was measured; parts larger than 2^23 / 4 pixels are too.
/// `cells` are all of the plan; those that are drawn get the paths, and are written; those that an earlier run measured
/// stay as they are. Cost: 16 lookups and shadings of the part for each, and about one tracing of it for each view.
void draw_supersampled_pictures(measure::Renderer& renderer, const RunPlan& plan, truth::TruthCache& cache,
                                std::vector<records::CellRecord>& cells);

}  // namespace shadowbench::run
