#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "harness/measure/scene_measurement.h"
#include "harness/measure/scene_truth.h"
#include "harness/options/options.h"
#include "report/analysis/limits.h"
#include "report/images/image.h"
#include "report/records/records.h"

namespace shadowbench::run {

/// The stem of all files of a task: the scene, with view and map size where the run has several.
std::string task_stem(const options::RunOptions& options, const measure::SceneTask& task);

/// What a grid says below a cell's name: its parameters, what it costs with a moving light, and its RMSE.
std::string caption_cell(const records::CellRecord& cell, const analysis::CostKind& cost, const records::GlRecord& gl);

/// The part of the picture, of this size, in which the filters disagree most about a shadow's edge.
images::Rect choose_crop(const std::vector<measure::MeasuredCell>& cells, images::Size size);

/// Writes each cell's picture, visibility and values, and the truth's, and notes their paths in the records; in place
/// of write_pictures() where the run has no grids. Safe for any part of a task's cells. Throws Error(kOutput).
void write_single_pictures(const options::RunOptions& options, const measure::SceneTask& task,
                           measure::SceneMeasurement& measured, const measure::SceneTruth& truth);

/// Writes a cell's picture, visibility and values, and notes their paths.
void write_cell_pictures(const options::RunOptions& options, const measure::SceneTask& task,
                         measure::MeasuredCell& cell);

/// Draws the grid of a task and notes its path.
void write_grid(const options::RunOptions& options, const measure::SceneTask& task, measure::SceneMeasurement& measured,
                const measure::SceneTruth& truth, const records::GlRecord& gl);

/// Writes what people look at: grid and single pictures; notes their paths in the records. `on_part` hears how much of
/// it is done, 0 .. 1, from many threads.
/// Throws Error(kOutput).
void write_pictures(const options::RunOptions& options, const measure::SceneTask& task,
                    measure::SceneMeasurement& measured, const measure::SceneTruth& truth, const records::GlRecord& gl,
                    const std::function<void(double part)>& on_part);

}  // namespace shadowbench::run
