#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "harness/measure/scene_assets.h"
#include "harness/measure/scene_measurement.h"
#include "harness/measure/scene_truth.h"
#include "harness/measure/view_receivers.h"
#include "harness/options/options.h"
#include "report/images/image.h"
#include "report/records/records.h"

namespace shadowbench::run {

/// The stem of all files of a task: the scene, with view and map size where the run has several.
std::string task_stem(const options::RunOptions& options, const measure::SceneTask& task);

/// The part of the picture, of this size, in which the filters disagree most about a shadow's edge.
images::Rect choose_crop(const std::vector<measure::MeasuredCell>& cells, images::Size size);

/// Writes a cell's picture, visibility and values, and notes their paths. `mask`: 1 where a pixel is a receiver.
void write_cell_pictures(const options::RunOptions& options, const measure::SceneTask& task,
                         measure::MeasuredCell& cell, const std::vector<std::uint8_t>& mask);

/// Writes files when it is called, on any thread and beside others. Throws Error(kOutput).
using FileJob = std::function<void()>;

/// Notes the paths of each cell's picture, visibility and values, and of the truth's, and returns what writes them.
/// Safe for any part of a task's cells. What it is given must outlive the jobs; they read its images alone.
std::vector<FileJob> plan_pictures(const options::RunOptions& options, const measure::SceneTask& task,
                                   measure::SceneMeasurement& measured, const measure::SceneTruth& truth);

/// Names a task's grid, which the report draws.
std::string name_grid(const options::RunOptions& options, const measure::SceneTask& task);

/// Notes the paths of what shows how a light's map lies on the scene, one file each for all cells of the task, and
/// returns what writes them: the depth map, and the texels per pixel.
/// What it is given must outlive the jobs.
std::vector<FileJob> plan_map_pictures(const options::RunOptions& options, const measure::SceneTask& task,
                                       measure::SceneMeasurement& measured, const measure::MapCoverage& coverage,
                                       const measure::LightMap& light);

/// Draws what every filter of a task makes of the receivers outside the map, beside each other: the right rule, then
/// each rule of an orthographic map that is wrong in one thing. Users' own filters, which have a process of their own,
/// are left out. Leaves the map as the run has it. Writes a PNG file. Throws Error(kOutput). Cost: four untimed lookups
/// a filter, and its prefilter as often.
void write_border_page(const std::filesystem::path& file, const measure::TaskRig& rig);

}  // namespace shadowbench::run
