#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "harness/gl/context/context.h"
#include "harness/measure/scene_measurement.h"
#include "harness/measure/scene_truth.h"
#include "harness/options/options.h"
#include "report/images/picture_io.h"
#include "report/records/error_parts.h"

namespace shadowbench::run {

/// The stem of all files of a task: the scene, with view and map size where the run has several.
std::string task_stem(const options::RunOptions& options, const measure::SceneTask& task);

/// The part of the picture, of this size, in which the filters disagree most about a shadow's edge.
images::Rect choose_crop(const std::vector<measure::MeasuredCell>& cells, images::Size size);

/// Names a task's float images below the report folder.
std::string exr_name(const options::RunOptions& options, const measure::SceneTask& task);

/// Give the names of a cell's parts in that file.
inline constexpr const char* kAmbientPart = "ambient";  ///< of a scene with several lights
inline constexpr const char* kTruthPart = "truth.area";
inline constexpr const char* kTruthMaskPart = "truth.mask";
inline constexpr const char* kTruthPicturePart = "truth.picture";
std::string picture_part(const std::string& label);
std::string error_part(const std::string& label, const records::ErrorPart& part);

/// Writes `<stem>.exr`: depth map, truth, and visibility and picture of each filter, with metadata to repeat the run.
/// Throws Error(kOutput).
void write_float_images(const options::RunOptions& options, const measure::SceneTask& task,
                        const measure::SceneMeasurement& measured, const measure::SceneTruth& truth,
                        const gl::GlInfo& info);

/// Writes each cell's picture, visibility and values, and the truth's, and notes their paths in the records; in place
/// of write_pictures() where the run has no grids. Safe for any part of a task's cells. Throws Error(kOutput).
void write_single_pictures(const options::RunOptions& options, const measure::SceneTask& task,
                           measure::SceneMeasurement& measured, const measure::SceneTruth& truth);

/// Notes in each record where that file has the cell's images.
void note_float_images(const options::RunOptions& options, const measure::SceneTask& task,
                       measure::SceneMeasurement& measured);

/// Moves a cell's images out of the parts of that file, by its label and its number of phases; images that the file
/// does not have stay empty.
void take_float_images(measure::MeasuredCell& cell, std::vector<images::Part>& parts);

/// Writes what people look at: grid and single pictures; notes their paths in the records. `on_part` hears how much of
/// it is done, 0 .. 1, from many threads.
/// Throws Error(kOutput).
void write_pictures(const options::RunOptions& options, const measure::SceneTask& task,
                    measure::SceneMeasurement& measured, const measure::SceneTruth& truth, const records::GlRecord& gl,
                    const std::function<void(double part)>& on_part);

}  // namespace shadowbench::run
