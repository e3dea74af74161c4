#pragma once

#include <string>

#include "harness/measure/scene_measurement.h"
#include "harness/options/options.h"

namespace shadowbench::run {

/// Measures a user's filter, beside `none`, in a process of its own, so that an endless loop or a driver that crashes
/// costs this cell and nothing else. `scene_argument` is what the command line calls the scene.
///
/// Returns the cell; its status says `timeout` or `crashed` where the process did not finish.
/// Throws Error(kFilter) for the filter's GLSL, with the worker's message, and what else the worker refuses.
measure::MeasuredCell measure_user_filter(const options::RunOptions& options, const measure::SceneTask& task,
                                          const filters::FilterRequest& request, const std::string& scene_argument,
                                          const std::string& backend);

}  // namespace shadowbench::run
