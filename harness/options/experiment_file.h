#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "filters/catalogue.h"

namespace shadowbench::options {

/// One key of an experiment file; says what the option of `shadowbench run` that bears its name would say.
struct ExperimentSetting {
  std::string option;               ///< "--map-size" for the key `map_size`
  std::vector<std::string> values;  ///< as the command line would have them; flags: "true" or "false"
  std::string where;                ///< "file:line"
};

/// One parameter of a filter with the values it is to take.
struct SweptParam {
  std::string name;
  std::vector<double> range;  ///< from, to; empty where `values` says all
  bool logarithmic = false;
  int count = 0;                    ///< values over the range, its ends included
  std::vector<std::string> values;  ///< as the command line would have them
};

/// One [[filter]]: every combination of its parameters' values is run.
struct SweptFilter {
  std::string id;
  std::vector<SweptParam> params;  ///< by name
  std::string where;               ///< "file:line"
};

/// What an experiment file says.
struct Experiment {
  std::string title;
  std::vector<ExperimentSetting> settings;
  std::vector<SweptFilter> filters;  ///< none: as the options say
};

/// Names the experiments of a folder.
std::vector<std::string> list_experiments(const std::filesystem::path& folder);

/// Finds an experiment: a path that ends in .toml, or the name of one that comes with the program.
/// Throws Error(kUsage) for another name, with the nearest or all there are.
std::filesystem::path find_experiment(const std::filesystem::path& folder, const std::string& name);

/// Reads an experiment file. Keys are the long options of `shadowbench run` with '_' for '-', of which `keys` are
/// known; a list stands for several values. Paths of scenes and filter files are relative to the file's folder. Throws
/// Error(kInput), with file and line, where it is missing, malformed, or holds an unknown key.
Experiment read_experiment(const std::filesystem::path& file, const std::vector<std::string>& keys);

/// Writes the filters of an experiment as `--filters` takes them: every combination of the values of each one's
/// parameters. Values over a range are rounded for whole-numbered parameters; what is then there twice is left out
/// once. Throws Error(kInput), with file and line, for an unknown filter or parameter, a value out of range, a range
/// without an end, or more than 100 000 combinations.
std::string expand_filters(const Experiment& experiment, const filters::Catalogue& catalogue);

}  // namespace shadowbench::options
