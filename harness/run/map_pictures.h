#pragma once

#include "harness/measure/map_coverage.h"
#include "harness/measure/scene_assets.h"
#include "harness/measure/scene_measurement.h"

namespace shadowbench::run {

/// Writes what shows how a light's map lies on the scene, one file each for all cells of the task: the depth map with
/// its histogram, the texels per pixel, and the texels on the surfaces; notes their paths in the records. Throws
/// Error(kOutput).
void write_map_pictures(const options::RunOptions& options, const measure::SceneTask& task,
                        measure::SceneMeasurement& measured, const measure::MapCoverage& coverage,
                        const measure::LightMap& light);

}  // namespace shadowbench::run
