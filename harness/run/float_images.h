#pragma once

#include <string>
#include <vector>

#include "harness/gl/context/context.h"
#include "harness/measure/scene_measurement.h"
#include "harness/measure/scene_truth.h"
#include "harness/options/options.h"
#include "report/images/picture_io.h"
#include "report/records/format.h"

namespace shadowbench::run {

/// Names a task's float images below the report folder.
std::string exr_name(const options::RunOptions& options, const measure::SceneTask& task);

/// Give the names of a cell's parts in that file.
inline constexpr const char* kAmbientPart = "ambient";  ///< of a scene with several lights
inline constexpr const char* kTruthPart = "truth.area";
inline constexpr const char* kTruthMaskPart = "truth.mask";
inline constexpr const char* kTruthPicturePart = "truth.picture";
inline constexpr const char* kBlockerPart = "truth.blocker";  ///< metres towards the light; 0: nothing blocks it
std::string picture_part(const std::string& label);
std::string error_part(const std::string& label, const records::ErrorPart& part);

/// Writes `<stem>.exr`: truth and the visibility of each filter, with metadata to repeat the run; pictures, parts of
/// errors, receivers and depth map where they are asked for. Throws Error(kOutput).
void write_float_images(const options::RunOptions& options, const measure::SceneTask& task,
                        const measure::SceneMeasurement& measured, const measure::SceneTruth& truth,
                        const gl::GlInfo& info);

/// Notes in each record where that file has the cell's images.
void note_float_images(const options::RunOptions& options, const measure::SceneTask& task,
                       measure::SceneMeasurement& measured);

/// Moves a cell's images out of the parts of that file, by its label and its number of phases; images that the file
/// does not have stay empty.
void take_float_images(measure::MeasuredCell& cell, std::vector<images::Part>& parts);

/// Writes how a task's cells were drawn, for the page to draw them again, and notes the file in their records; cells
/// without a frame, such as those of users' filters, which their workers write, stay as they are. With the frames goes
/// what the run drew of receivers and map around the picture's most disputed edge: a GPU that puts the edges of
/// triangles elsewhere can still be held against the run there. Where vertices are too many to go with a page, all of
/// receivers and map goes with the frames: view and light stay the run's then. Throws Error(kOutput).
void write_frames(const measure::TaskRig& rig, measure::SceneMeasurement& measured);

}  // namespace shadowbench::run
