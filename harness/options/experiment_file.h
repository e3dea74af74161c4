#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "filters/catalogue.h"
#include "harness/options/options.h"

namespace shadowbench::options {

/// One key of an experiment file. It stands for the option of `shadowbench run` that has the same name.
struct ExperimentSetting {
  std::string option;               ///< "--map-size" for the key `map_size`
  std::vector<std::string> values;  ///< as on the command line; "true" or "false" for flags
  std::string where;                ///< "file:line"
};

/// One parameter of a filter, with the values that it takes in turn.
struct SweptParam {
  std::string name;
  std::vector<double> range;  ///< its two ends; empty where `values` holds all values
  bool logarithmic = false;
  int count = 0;                    ///< of values over the range, its ends included
  std::vector<std::string> values;  ///< as on the command line
};

/// One [[filter]]: every combination of its parameters' values is run.
struct SweptFilter {
  std::string id;
  std::vector<SweptParam> params;  ///< by name
  std::string where;               ///< "file:line"
};

/// One [[engine]]: another renderer, as a command of the shell that draws a scene.
struct Engine {
  std::string name;                   ///< of its rows
  std::string command;                ///< is given a scene.json and the EXR file to write
  std::filesystem::path folder = {};  ///< it is run there; empty: where the program is
};

/// What an experiment file says.
struct Experiment {
  std::string title;
  std::vector<ExperimentSetting> settings;
  std::vector<SweptFilter> filters;  ///< empty: the options name the filters
  std::vector<Engine> engines;       ///< whose pictures are scored once the run is done
};

/// Finds an experiment: a path that ends in .toml, or the name of one that comes with the program.
/// Throws Error(kUsage) for an unknown name; the message holds the nearest name, or all of them.
std::filesystem::path find_experiment(const std::filesystem::path& folder, const std::string& name);

/// Reads an experiment file. Its keys are the options of `shadowbench run` that do not say where or how; a list stands
/// for several values. Paths of scenes and filter files are relative to the file's folder. Throws Error(kInput), with
/// file and line, where it is missing, malformed, or holds an unknown key.
Experiment read_experiment(const std::filesystem::path& file);

/// Writes the experiment file that says what the options say, with the parameters of filters that were asked for.
/// Paths stay as they are.
std::string write_experiment(const RunOptions& options);

/// Writes the filters of an experiment as `--filters` takes them: every combination of the values of each one's
/// parameters. Values over a range are rounded for whole-numbered parameters, and of equal values one is kept. Throws
/// Error(kInput), with file and line, for an unknown filter or parameter, a value out of range, a range without an end,
/// or more than 100 000 combinations.
std::string expand_filters(const Experiment& experiment, const filters::Catalogue& catalogue);

}  // namespace shadowbench::options
