#pragma once

#include <string>
#include <vector>

#include "harness/options/options.h"
#include "harness/scene/scene.h"

namespace shadowbench::run {

/// Loads a scene as a run wants it: framed for the picture's shape, with the floor and the light that were asked for.
/// Throws Error as scene::load().
scene::Scene load_scene(const options::RunOptions& options, const std::string& argument);

/// Loads all of a run's scenes, in its order. Throws Error as load_scene(), and Error(kUsage) where two have one name.
std::vector<scene::Scene> load_scenes(const options::RunOptions& options);

}  // namespace shadowbench::run
