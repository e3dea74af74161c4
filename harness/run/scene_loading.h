#pragma once

#include <string>
#include <vector>

#include "harness/options/options.h"
#include "harness/scene/scene.h"

namespace shadowbench::run {

/// Loads a scene as a run wants it: framed for the picture's shape, with the floor and the light that were asked for.
/// Throws Error as scene::load().
scene::Scene load_scene(const options::RunOptions& options, const std::string& argument);

/// The scene under each of its lights that was asked for, by itself; all where none was named, none where it has none
/// of these.
std::vector<scene::Scene> list_lit_scenes(const options::RunOptions& options, const scene::Scene& scene);

/// Throws Error(kUsage): no scene has a light that was asked for.
[[noreturn]] void fail_unknown_light(const options::RunOptions& options);

/// Loads all of a run's scenes, in its order. Throws Error as load_scene(), and Error(kUsage) where two have one name.
std::vector<scene::Scene> load_scenes(const options::RunOptions& options);

/// What the user is to know of one light's scene before it is measured: the warnings of loading, which other lights of
/// the scene repeat, and whether its light shows nothing.
std::vector<std::string> list_scene_warnings(const options::RunOptions& options, const scene::Scene& scene);

}  // namespace shadowbench::run
