#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "base/text.h"
#include "filters/catalogue.h"
#include "harness/cli/command_line.h"
#include "harness/options/experiment_file.h"
#include "harness/options/run_options.h"

namespace shadowbench::cli {

// What commands share: options of the same name and help, and the reading of their values. All functions but
// find_results() throw Error(kUsage) with the option's name.

using options::fail;
using options::parse_count;
using options::parse_light;
using options::parse_picture_size;

/// The options of every command that draws, as text.
struct DrawingArguments {
  std::string backend = "auto";
  std::string cache;
  bool no_cache = false;
  std::string out;
  bool force = false;
};

/// The options of commands that draw pictures of one size with one map.
struct PictureArguments : DrawingArguments {
  std::string filters;
  std::string map_size = "1024";
  std::string fit = "tight";
  std::string size;
};

/// Adds --force.
void add_force_option(Command& command, bool& force);

/// Adds --gl, --cache, --no-cache, --out and --force.
void add_drawing_options(Command& command, DrawingArguments& arguments, const std::string& cache_default = "as 'run'");

/// Adds --gl.
void add_backend_option(Command& command, std::string& backend);

/// Adds --filters, for commands that take built-in filters alone.
void add_builtin_filters_option(Command& command, std::string& filters);

/// Adds --scene for one scene.
void add_scene_option(Command& command, std::string& scene);

/// Adds an option of `run` as that describes it.
void add_as_run(Command& command, const char* name, Variable variable);

/// Adds --map-size and --size.
void add_picture_options(Command& command, PictureArguments& arguments);

/// Adds --json.
void add_json_option(Command& command, bool& json);

/// The folder for traced images; empty: nothing is kept.
std::filesystem::path choose_cache(const DrawingArguments& arguments);

/// Takes over what these options say, and finds the program's folders.
template <class Options>
void take_drawing_options(const DrawingArguments& arguments, Options& options) {
  options.resources = options::find_resources();
  options.backend = parse_name<gl::Backend>(arguments.backend, "GL back end");
  options.cache = choose_cache(arguments);
  options.out = arguments.out;
  options.force = arguments.force;
}

/// Takes over what the options of DrawingArguments, --map-size and --size say, but for the filters.
void take_picture_options(const PictureArguments& arguments, options::RunOptions& options);

/// Names the built-in scenes.
std::vector<std::string> list_builtin_scenes(const options::Resources& resources);

/// Parses the filters that --filters names, and adds those of the user's files that it does not name, which the
/// catalogue has.
std::vector<filters::FilterRequest> parse_filters(const filters::Catalogue& catalogue, const std::string& text,
                                                  const std::vector<std::string>& files);

/// Refuses filters that are named twice with the same parameters.
void require_distinct(const std::vector<filters::FilterRequest>& requests);

/// What the user should know about each preset that was asked for.
std::vector<std::string> describe_presets(const std::vector<filters::FilterRequest>& requests);

/// Prints that, where a command has no notes to add it to.
void print_presets(const std::vector<filters::FilterRequest>& requests);

/// Parses the built-in filters that --filters names, refuses one that is named twice, and calls print_presets().
std::vector<filters::FilterRequest> parse_builtin_filters(const std::string& text, const options::Resources& resources);

/// The results.json of a run, which is named by its folder or by that file. Throws Error(kInput) where there is
/// neither.
std::filesystem::path find_results(const std::filesystem::path& run);

/// The experiment of a run that names none, whose filters are those of every run that names none.
inline constexpr const char* kDefaultExperiment = "default";

/// The times of the others are given as ratios to its times.
inline constexpr const char* kReferenceFilter = "none";

/// The options of `shadowbench run` as they are told; all of them are checked before anything is made.
struct RunArguments : DrawingArguments {
  std::string experiment = kDefaultExperiment;
  std::vector<options::RunOption> told = options::list_run_options();
  bool strict = false;
  bool allow_commands = false;
  std::vector<options::Engine> engines;  ///< of the experiment
  bool worker = false;
  bool check = false;       ///< as a worker: only compile the filters
  bool every_step = false;  ///< show a line for each step, as the window reads them

  /// 1: grids are drawn, -1: they are not, 0: where there are few filters.
  int& grids() { return options::find_told<int>(told, "--grids"); }
};

/// Adds the options of `shadowbench run`; parsing fills `arguments`, which must outlive the command.
void add_run_options(Command& command, RunArguments& arguments);

/// Adds some of them, by their names.
void add_told(Command& command, RunArguments& arguments, const std::vector<std::string>& names = {});

/// Adds --strict. `means` says what is done all the same.
void add_strict(Command& command, RunArguments& arguments, const std::string& means);

/// What --strict asks for. Throws Error(kLimit), with the first, where there are warnings of `owner`.
void require_no_warnings(const std::vector<std::string>& warnings, const std::string& owner);

/// Takes what an experiment file says for every option that was not given on the command line. An experiment that names
/// no filters takes those of the default one. Returns the experiment's title. Throws Error as options::read_experiment
/// and options::expand_filters, and Error(kInput) for a value that its option refuses.
std::string apply_experiment(const CommandLine& line, RunArguments& arguments);

/// Checks what is told of a run, and makes its options of it; `words` are kept for the record.
/// Throws Error(kUsage) with the option's name, and Error for a filter's file.
options::RunOptions make_run_options(RunArguments& arguments, std::vector<std::string> words);

}  // namespace shadowbench::cli
