#pragma once

#include <filesystem>
#include <string>

#include "harness/run/options.h"
#include "harness/run/scene_measurement.h"
#include "harness/run/scene_truth.h"

namespace shadowbench::run {

/// Gives the stem of all files of a task: the scene, with view and map size where the run has several.
std::string task_stem(const RunOptions& options, const SceneTask& task);

/// Gives the name of a task's float images below the report folder.
std::string exr_name(const RunOptions& options, const SceneTask& task);

/// Give the names of a cell's parts in that file.
std::string visibility_part(const std::string& label);
std::string picture_part(const std::string& label);
std::string stability_part(const std::string& label, const report::StabilityImage& image);
std::string uncertainty_part(const std::string& label, const report::UncertaintyImage& image);

/// Writes `<stem>.exr`: depth map, truth, and visibility and picture of each filter, with metadata to repeat the run.
/// Throws Error(kOutput).
void write_float_images(const RunOptions& options, const SceneTask& task, const SceneMeasurement& measured,
                        const SceneTruth& truth, const gl::GlInfo& info);

/// Writes each cell's picture and visibility and notes their paths in the records; in place of write_pictures() where
/// the run has no grids. Safe for any part of a task's cells. Throws Error(kOutput).
void write_single_pictures(const RunOptions& options, const SceneTask& task, SceneMeasurement& measured);

/// Writes what people look at: grid and single pictures; notes their paths in the records.
/// Throws Error(kOutput).
void write_pictures(const RunOptions& options, const SceneTask& task, SceneMeasurement& measured,
                    const SceneTruth& truth, const report::GlRecord& gl);

}  // namespace shadowbench::run
