#pragma once

#include <filesystem>

#include "harness/measure/map_coverage.h"
#include "harness/measure/renderer.h"
#include "harness/measure/scene_assets.h"
#include "harness/measure/scene_measurement.h"
#include "harness/run/task_images.h"

namespace shadowbench::run {

/// Notes the paths of what shows how a light's map lies on the scene, one file each for all cells of the task, and
/// returns what writes them: the depth map with its histogram, the texels per pixel, and the texels on the surfaces.
/// What it is given must outlive the jobs.
std::vector<FileJob> plan_map_pictures(const options::RunOptions& options, const measure::SceneTask& task,
                                       measure::SceneMeasurement& measured, const measure::MapCoverage& coverage,
                                       const measure::LightMap& light);

/// Draws what every filter of a task makes of the receivers outside the map, beside each other: the right rule, then
/// each rule of an orthographic map that is wrong in one thing. Users' own filters, which have a process of their own,
/// are left out. Leaves the map as the run has it. Writes a PNG file. Throws Error(kOutput). Cost: four untimed lookups
/// a filter, and its prefilter as often.
void write_border_page(const std::filesystem::path& file, measure::Renderer& renderer,
                       const options::RunOptions& options, const measure::SceneTask& task,
                       measure::SceneAssets& assets);

}  // namespace shadowbench::run
