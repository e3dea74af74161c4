#pragma once

#include <string>
#include <vector>

#include "harness/cli/arguments.h"
#include "harness/options/experiment_file.h"

namespace shadowbench::cli {

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
