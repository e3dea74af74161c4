#include "harness/cli/arguments.h"

#include <fmt/format.h>

#include <algorithm>
#include <tuple>

#include "base/error.h"
#include "harness/cli/print.h"
#include "harness/scene/load.h"

namespace shadowbench::cli {
void add_backend_option(Command& command, std::string& backend) {
  command.add("--gl", &backend, "OpenGL context: auto, software, osmesa, egl or glfw");
}

void add_force_option(Command& command, bool& force) {
  command.add("--force", &force, "write into the folder despite files that shadowbench did not write");
}

void add_drawing_options(Command& command, DrawingArguments& arguments, const std::string& cache_default) {
  add_backend_option(command, arguments.backend);
  command
      .add("--cache", &arguments.cache,
           fmt::format("folder that keeps traced images for later runs (default {})", cache_default))
      .names(ValueKind::kFolder);
  command.add("--no-cache", &arguments.no_cache, "trace everything anew, keep nothing");
  command.add("--out", &arguments.out, "folder of the report").names(ValueKind::kFolder);
  add_force_option(command, arguments.force);
}

void add_builtin_filters_option(Command& command, std::string& filters) {
  command
      .add("--filters", &filters,
           "built-in filters with parameters, or @PRESET (default: all but those for teaching; see 'list filters' and "
           "'list presets')")
      .names(ValueKind::kFilters)
      .also_called("--filter");
}

void add_scene_option(Command& command, std::string& scene) {
  command
      .add("--scene", &scene, "a built-in scene, or a .toml, .gltf, .glb or .obj file, or a folder with one of these")
      .names(ValueKind::kScene);
}

void add_as_run(Command& command, const char* name, Variable variable) {
  for (Option option : options::list_run_options()) {
    if (option.name != name) continue;
    option.variable = variable;
    option.in("Options").rare = false;
    command.options.push_back(std::move(option));
  }
}

void add_picture_options(Command& command, PictureArguments& arguments) {
  command.add("--map-size", &arguments.map_size, "texels along a side of the shadow map");
  command.add("--fit", &arguments.fit, "how the light's map is fitted, as for 'run'");
  command.add("--size", &arguments.size, "picture size in pixels, WIDTHxHEIGHT");
}

void add_json_option(Command& command, bool& json) { command.add("--json", &json, "print JSON"); }

std::filesystem::path choose_cache(const DrawingArguments& arguments) {
  if (arguments.no_cache) return {};
  return arguments.cache.empty() ? options::default_cache_folder() : std::filesystem::path(arguments.cache);
}

void take_picture_options(const PictureArguments& arguments, options::RunOptions& options) {
  take_drawing_options(arguments, options);
  options.map_sizes = {parse_count(arguments.map_size, "--map-size")};
  options.fit = scene::parse_fit_rule(arguments.fit);
  options.fits = {options.fit};
  std::tie(options.width, options.height) = parse_picture_size(arguments.size);
}

std::vector<filters::FilterRequest> parse_filters(const filters::Catalogue& catalogue, const std::string& text,
                                                  const std::vector<std::string>& files) {
  std::vector<filters::FilterRequest> requests = catalogue.parse_requests(text);
  for (const std::string& file : files) {
    const std::string id = std::filesystem::path(file).stem().string();
    const auto is_it = [&](const filters::FilterRequest& request) { return request.spec.id == id; };
    if (std::ranges::none_of(requests, is_it)) requests.push_back(catalogue.parse_requests(id).front());
  }
  return requests;
}

void require_distinct(const std::vector<filters::FilterRequest>& requests) {
  for (std::size_t i = 0; i < requests.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      const filters::FilterRequest &a = requests[i], &b = requests[j];
      if (filters::is_same(a, b))
        fail(fmt::format("--filters names '{}' twice: '{}' has the same parameters", a.label(), b.label()));
    }
  }
}

std::vector<std::string> describe_presets(const std::vector<filters::FilterRequest>& requests) {
  std::vector<std::string> notes;
  for (const filters::FilterRequest& request : requests)
    for (const filters::Preset& preset : request.presets) notes.push_back(filters::describe_preset(preset));
  return notes;
}

void print_presets(const std::vector<filters::FilterRequest>& requests) {
  for (const std::string& note : describe_presets(requests)) print_message("note: {}\n", note);
}

std::vector<filters::FilterRequest> parse_builtin_filters(const std::string& text,
                                                          const options::Resources& resources) {
  std::vector<filters::FilterRequest> requests = filters::Catalogue(resources.filters).parse_requests(text);
  filters::refuse_light_widths(requests);
  require_distinct(requests);
  print_presets(requests);
  return requests;
}

std::vector<std::string> list_builtin_scenes(const options::Resources& resources) {
  std::vector<std::string> names;
  for (const scene::SceneInfo& info : scene::list_scenes(resources.scenes)) names.push_back(info.name);
  return names;
}

std::filesystem::path find_results(const std::filesystem::path& run) {
  std::error_code error;
  const std::filesystem::file_status status = std::filesystem::status(run, error);
  if (std::filesystem::is_directory(status)) return run / "results.json";
  if (std::filesystem::exists(status)) return run;
  throw Error(ErrorKind::kInput,
              fmt::format("there is no such folder or file ({}); give a run's folder (its --out), or its results.json",
                          error.message()),
              run.string());
}

}  // namespace shadowbench::cli
