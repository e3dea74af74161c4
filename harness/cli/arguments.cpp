#include "harness/cli/arguments.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <tuple>

#include "filters/base/error.h"
#include "harness/scene/load.h"

namespace shadowbench::cli {
namespace {

double parse_angle(const std::string& text, const char* name, double limit_deg) {
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || !(std::abs(value) <= limit_deg))
    fail(fmt::format("--light: the {} '{}' must be a number of degrees, {} .. {}", name, text, -limit_deg, limit_deg));
  return value;
}

}  // namespace

void add_backend_option(Command& command, std::string& backend) {
  command.add("--gl", &backend, "OpenGL context: auto, software, osmesa, egl or glfw")
      .such_as({"auto", "software", "osmesa", "egl", "glfw"});
}

void add_drawing_options(Command& command, DrawingArguments& arguments, const std::string& cache_default) {
  add_backend_option(command, arguments.backend);
  command
      .add("--cache", &arguments.cache,
           fmt::format("folder that keeps traced images for later runs (default: {})", cache_default))
      .names(ValueKind::kFolder);
  command.add("--no-cache", &arguments.no_cache, "trace everything, keep nothing");
  command.add("--out", &arguments.out, "folder of the report").names(ValueKind::kFolder);
}

void add_builtin_filters_option(Command& command, std::string& filters) {
  command
      .add(kFiltersOption, &filters,
           "built-in filters with parameters (default: all but those for teaching; see 'list filters')")
      .names(ValueKind::kFilters)
      .also_called(kFilterOption);
}

void add_scene_option(Command& command, std::string& scene) {
  command
      .add("--scene", &scene, "a built-in scene, or a .toml, .gltf, .glb or .obj file, or a folder with one of these")
      .names(ValueKind::kScene);
}

void add_scenes_options(Command& command, std::vector<std::string>& scenes, bool& ground) {
  command
      .add("--scene", &scenes,
           "a built-in scene, or a .toml, .gltf, .glb or .obj file, or a folder with one of these; may be repeated "
           "(default: all built-in scenes)")
      .names(ValueKind::kScene);
  command.add("--ground", &ground, "put a floor under a bare model");
}

void add_picture_options(Command& command, PictureArguments& arguments) {
  command.add("--map-size", &arguments.map_size, "texels along a side of the shadow map");
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
  std::tie(options.width, options.height) = parse_picture_size(arguments.size);
}

void fail(const std::string& message) { throw Error(ErrorKind::kUsage, message); }

int parse_count(const std::string& text, const char* option) {
  int value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || value < 1)
    fail(fmt::format("{}: '{}' must be a whole number, 1 or more", option, text));
  return value;
}

std::pair<int, int> parse_picture_size(const std::string& text) {
  const std::size_t cross = text.find('x');
  if (cross == std::string::npos) fail(fmt::format("--size: '{}' must be WIDTHxHEIGHT, such as 960x540", text));
  return {parse_count(text.substr(0, cross), "--size"), parse_count(text.substr(cross + 1), "--size")};
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

std::vector<filters::FilterRequest> parse_builtin_filters(const std::string& text,
                                                          const options::Resources& resources) {
  std::vector<filters::FilterRequest> requests = filters::Catalogue(resources.filters).parse_requests(text);
  require_distinct(requests);
  return requests;
}

scene::SkyAngles parse_light(const std::string& text) {
  const std::size_t comma = text.find(',');
  if (comma == std::string::npos)
    fail(fmt::format("--light: '{}' must be AZIMUTH,ELEVATION in degrees, such as 120,35", text));
  return {parse_angle(text.substr(0, comma), "azimuth", 360.0), parse_angle(text.substr(comma + 1), "elevation", 90.0)};
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
