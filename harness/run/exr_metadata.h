#pragma once

#include "harness/gl/context/context.h"
#include "harness/measure/scene_measurement.h"
#include "harness/options/options.h"
#include "report/images/picture_io.h"

namespace shadowbench::run {

/// What the EXR file of a task says beside its pictures: the run, the camera and the light; for every layer of the map
/// how a point of the world is found in it, and the bias of every filter. With its parts `receiver.position`,
/// `receiver.normal` and `depth_map` a reader can compute a filter again (tests/exr does).
images::Metadata describe_task(const options::RunOptions& options, const measure::SceneTask& task,
                               const measure::SceneMeasurement& measured, const gl::GlInfo& info);

}  // namespace shadowbench::run
