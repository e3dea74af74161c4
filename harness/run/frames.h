#pragma once

#include "harness/measure/scene_measurement.h"
#include "harness/options/options.h"

namespace shadowbench::run {

/// Writes how a task's cells were drawn, for the page to draw them again, and notes the file in their records; cells
/// without a frame, such as those of users' filters, which their workers write, stay as they are. With the frames goes
/// what the run drew of receivers and map around the picture's hardest edge: a GPU that puts the edges of triangles
/// elsewhere can still be held against the run there. Where vertices are too many to go with a page, all of receivers
/// and map goes with the frames: view and light stay the run's then. Throws Error(kOutput).
void write_frames(measure::Renderer& renderer, const options::RunOptions& options, const measure::SceneTask& task,
                  measure::SceneAssets& assets, measure::SceneMeasurement& measured);

}  // namespace shadowbench::run
