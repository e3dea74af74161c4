#include "harness/cli/arguments.h"

#include <fmt/format.h>

#include <algorithm>
#include <tuple>

#include "base/error.h"
#include "harness/cli/terminal.h"
#include "harness/scene/load.h"
#include "harness/tune/tune_filters.h"

namespace shadowbench::cli {
namespace {

/// The filters that are told by name, and those whose files are told.
void choose_filters(options::RunOptions& options, RunArguments& arguments) {
  filters::Catalogue catalogue(options.resources.filters);
  catalogue.add_user_files(options.filter_files);
  options.reference = catalogue.parse_requests(kReferenceFilter).front();
  options.filters =
      parse_filters(catalogue, options::find_told<std::string>(arguments.told, "--filters"), options.filter_files);
  if (!options.kernel_width.empty()) filters::set_widths(options.filters, options.kernel_width);
  if (const auto& tuned = options::find_told<std::string>(arguments.told, "--tuned"); !tuned.empty())
    options.notes = tune::apply_tuned(options.filters, catalogue, tuned, options.map_sizes, options.fits);
  require_distinct(options.filters);
  for (std::string& note : describe_presets(options.filters)) options.notes.push_back(std::move(note));
  options.grids =
      arguments.grids() > 0 || (arguments.grids() == 0 && options.filters.size() <= options::kFiltersOfAGrid);
}

}  // namespace

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

void add_told(Command& command, RunArguments& arguments, const std::vector<std::string>& names) {
  for (options::RunOption& each : arguments.told) {
    if (!names.empty() && std::ranges::count(names, each.name) == 0) continue;
    each.variable = std::visit([](auto& told) { return Variable(&told); }, each.told);
    command.options.push_back(each);
    if (!names.empty()) command.options.back().in("Options").rare = false;
  }
}

void add_run_options(Command& command, RunArguments& a) {
  a.out = "report/out";
  command.add("experiment", &a.experiment, "name or .toml file; options override its keys (default: 'default')");
  add_told(command, a);
  const std::size_t told = command.options.size();
  command.add("--allow-commands", &a.allow_commands,
              "run the commands of the experiment's [[engine]] tables without asking; they are printed first");
  add_strict(command, a, "exit code 1 if the finished run has a warning or a failed cell; the report is written");
  add_drawing_options(command, a, "shadowbench in $XDG_CACHE_HOME or ~/.cache");
  command.add("--worker", &a.worker, "").hide();
  command.add("--check", &a.check, "").hide();
  command.add("--every-step", &a.every_step, "").hide();
  for (std::size_t i = told; i < command.options.size(); ++i) {
    Option& option = command.options[i].in("Output");
    if (option.name != "--out" && option.name != "--gl") option.rarely();
  }
}

void add_strict(Command& command, RunArguments& arguments, const std::string& means) {
  command.add("--strict", &arguments.strict, means + " all the same");
}

void require_no_warnings(const std::vector<std::string>& warnings, const std::string& owner) {
  if (warnings.empty()) return;
  throw Error(ErrorKind::kLimit, fmt::format("--strict: the {} has {} warning{}: {}", owner, warnings.size(),
                                             warnings.size() == 1 ? "" : "s, the first", warnings.front()));
}

std::string apply_experiment(const CommandLine& line, RunArguments& arguments) {
  const options::Resources resources = options::find_resources();
  const auto read = [&](const std::string& name) {
    return options::read_experiment(options::find_experiment(resources.experiments, name));
  };
  const auto take = [&](const options::ExperimentSetting& setting) {
    if (!line.has(setting.option)) line.set(setting.option, setting.values, setting.where);
  };
  const options::Experiment experiment = read(arguments.experiment);
  std::ranges::for_each(experiment.settings, take);
  arguments.engines = experiment.engines;
  if (line.has("--filters")) return experiment.title;
  if (experiment.filters.empty()) {
    for (const options::ExperimentSetting& setting : read(kDefaultExperiment).settings)
      if (setting.option == "--filters" || setting.option == "--width") take(setting);
    return experiment.title;
  }
  filters::Catalogue catalogue(resources.filters);
  catalogue.add_user_files(options::find_told<std::vector<std::string>>(arguments.told, "--filter-file"));
  options::find_told<std::string>(arguments.told, "--filters") = options::expand_filters(experiment, catalogue);
  return experiment.title;
}

options::RunOptions make_run_options(RunArguments& arguments, std::vector<std::string> words) {
  options::RunOptions options;
  take_drawing_options(arguments, options);
  options::read_run_options(arguments.told, options);
  if (options.scenes.empty()) options.scenes = list_builtin_scenes(options.resources);
  choose_filters(options, arguments);
  options::check_run_options(options);
  options.command = std::move(words);
  if (arguments.worker) options.part.product = options::Product::kImages;
  if (arguments.check) options.part.product = options::Product::kPrograms;
  return options;
}

}  // namespace shadowbench::cli
