#include "harness/view/save.h"

#include <fmt/format.h>
#include <toml++/toml.h>

#include <set>
#include <system_error>

#include "filters/base/atomic_file.h"
#include "filters/base/error.h"
#include "filters/base/toml.h"
#include "harness/gl/pixel_format.h"
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

std::string write_title(const ViewState& state) {
  return fmt::format("{}: {} and {}", state.scene.title, state.sides[0].label(), state.sides[1].label());
}

toml::table write_filter(const filters::FilterRequest& request) {
  toml::table table{{"id", request.spec.id}};
  for (const auto& [name, value] : request.values)
    std::visit([&, &key = name](const auto& each) { table.insert(key, each); }, value);
  return table;
}

const char* write_switch(bool on) { return on ? "on" : "off"; }

void add_map(toml::table& table, const options::RunOptions& options) {
  table.insert("map_size", options.map_sizes.front());
  table.insert("map_format", gl::pixel_format(options.map.format).name);
  if (options.map.curve.reversed) table.insert("reversed_depth", true);
  if (!options.map.curve.is_linear()) table.insert("perspective_depth", options.map.curve.far_over_near);
  table.insert("fit", scene::describe_fit(options.fit));
  table.insert("snap", write_switch(options.snap));
  if (options.pad_texels) table.insert("pad_texels", *options.pad_texels);
}

void add_lookup(toml::table& table, const options::RunOptions& options) {
  toml::array bias;
  for (const std::string& text : options.bias_texts) bias.push_back(text);
  if (!bias.empty()) table.insert("bias", std::move(bias));
  table.insert("border", filters::to_string(options.range.border));
  table.insert("far_test", write_switch(options.range.far_test));
  table.insert("behind_test", write_switch(options.range.behind_test));
  table.insert("seed", options.seed);
}

void add_filters(toml::table& table, const ViewState& state, const fs::path& file) {
  toml::array filters, files;
  std::set<std::string> named;
  for (const filters::FilterRequest& request : state.options.filters) {
    filters.push_back(write_filter(request));
    if (request.user_file && named.insert(request.spec.path).second)
      files.push_back(scene::name_from(request.spec.path, file));
  }
  // An experiment without filters would take the default ones.
  if (filters.empty()) filters.push_back(toml::table{{"id", state.options.reference.spec.id}});
  if (!files.empty()) table.insert("filter_file", std::move(files));
  table.insert("filter", std::move(filters));
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

std::string write_experiment(const ViewState& state, const fs::path& file) {
  const options::RunOptions& options = state.options;
  toml::table table{{"title", write_title(state)},
                    {"scene", scene_beside(file).filename().string()},
                    {"size", fmt::format("{}x{}", options.width, options.height)}};
  if (state.cameras.size() > 1) table.insert("view", state.active_camera().name);
  if (state.lights.size() > 1) table.insert("light_name", state.lights[state.light].name);
  add_map(table, options);
  add_lookup(table, options);
  add_filters(table, state, file);
  return write_toml(table);
}

void save_experiment(const ViewState& state, const fs::path& file) {
  require_free(state, file);
  save_scene(state, scene_beside(file));
  write_text_file(file, write_experiment(state, file));
}

}  // namespace shadowbench::view
