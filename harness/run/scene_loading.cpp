#include "harness/run/scene_loading.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/error.h"
#include "harness/scene/load.h"

namespace shadowbench::run {

scene::Scene load_scene(const options::RunOptions& options, const std::string& argument) {
  scene::LoadOptions load;
  load.scenes_folder = options.resources.scenes;
  load.ground = options.ground;
  load.aspect = static_cast<double>(options.width) / options.height;
  load.light = options.light;
  return scene::load(argument, load);
}

std::vector<scene::Scene> load_scenes(const options::RunOptions& options) {
  std::vector<scene::Scene> scenes;
  for (const std::string& argument : options.scenes) {
    scene::Scene scene = load_scene(options, argument);
    const auto same_name = [&](const scene::Scene& known) { return known.name == scene.name; };
    if (std::any_of(scenes.begin(), scenes.end(), same_name)) {
      throw Error(ErrorKind::kUsage,
                  fmt::format("two scenes are called '{}': rename one file, or run them apart", scene.name));
    }
    scenes.push_back(std::move(scene));
  }
  return scenes;
}

}  // namespace shadowbench::run
