#include "harness/view/save.h"

#include <fmt/format.h>

#include <algorithm>
#include <system_error>

#include "base/atomic_file.h"
#include "base/error.h"
#include "harness/options/experiment_file.h"
#include "harness/scene/load.h"
#include "harness/scene/scene_writer.h"

namespace shadowbench::view {
namespace {

namespace fs = std::filesystem;

fs::path find_source(const ViewState& state) {
  return scene::find_scene_file(state.scene_argument, state.options.resources.scenes);
}

bool is_same(const fs::path& a, const fs::path& b) {
  std::error_code missing;
  return fs::equivalent(a, b, missing);
}

/// Refuses a file that would take the place of a scene that others count on.
void require_free(const ViewState& state, const fs::path& file) {
  const auto refuse = [&](const char* why) { throw Error(ErrorKind::kUsage, why, file.string()); };
  if (file.extension() != ".toml") refuse("the name of a scene or an experiment must end in .toml");
  if (is_same(file, find_source(state))) refuse("the scene was loaded from this file: choose another name");
  const fs::path& scenes = state.options.resources.scenes;
  const fs::path folder = fs::absolute(file).parent_path();
  if (is_same(folder, scenes) || is_same(folder, scenes / "teaching"))
    refuse("this is the folder of the built-in scenes: choose another one");
}

std::string write_scene(const ViewState& state, const fs::path& file) {
  return scene::write_scene({find_source(state), &state.scene, state.cameras, state.lights}, file);
}

}  // namespace

void settle(ViewSettings& settings) {
  for (scene::Camera& camera : settings.cameras) camera = scene::settle(camera);
  for (scene::Light& light : settings.lights) light = scene::settle(light);
}

void save_scene(const ViewState& state, const fs::path& file) {
  require_free(state, file);
  write_text_file(file, write_scene(state, file));
}

fs::path scene_beside(const fs::path& experiment) {
  return experiment.parent_path() / (experiment.stem().string() + ".scene.toml");
}

std::string write_experiment(const ViewState& state, options::RunOptions options, const fs::path& file) {
  options.title = fmt::format("{}: {} and {}", state.scene.title, state.sides[0].label(), state.sides[1].label());
  options.scenes = {scene_beside(file).filename().string()};
  options.ground = false;  // the scene's file has the floor
  if (state.cameras.size() > 1) options.views = {state.active_camera().name};
  if (state.lights.size() > 1) options.light_names = {state.lights[state.light].name};
  options.sizes = {{options.width, options.height}};
  // An experiment without filters would take the default ones.
  if (options.filters.empty()) options.filters = {options.reference};
  options.filter_files.clear();
  for (filters::FilterRequest& request : options.filters) {
    request.set_by_user.clear();
    for (const auto& [name, value] : request.values) request.set_by_user.insert(name);
    if (!request.user_file) continue;
    const std::string name = scene::name_from(request.spec.path, file);
    if (std::ranges::count(options.filter_files, name) == 0) options.filter_files.push_back(name);
  }
  return options::write_experiment(options);
}

void save_experiment(const ViewState& state, const fs::path& file) {
  require_free(state, file);
  save_scene(state, scene_beside(file));
  write_text_file(file, write_experiment(state, state.options, file));
}

}  // namespace shadowbench::view
