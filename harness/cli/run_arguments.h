#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "harness/cli/arguments.h"

namespace shadowbench::cli {

/// A run of more filters draws grids only where it is told to, because nobody could read them.
inline constexpr int kFiltersOfAGrid = 16;

/// The experiment of a run that names none, whose filters are those of every run that names none.
inline constexpr const char* kDefaultExperiment = "default";

/// The options of `shadowbench run` as text; all of them are checked before anything is made.
struct RunArguments : DrawingArguments {
  std::string experiment = kDefaultExperiment;
  std::vector<std::string> scenes;
  bool ground = false;
  std::vector<std::string> filter_files;
  std::string map_sizes = "1024";
  std::string sizes = "960x540";
  std::vector<std::string> bias;
  std::vector<std::string> fits;
  std::string snap = "off";
  std::string map_format = "d32f";
  bool reversed_depth = false;
  std::optional<double> perspective_depth;
  std::string light;
  std::string border = "border";
  std::string far_test = "on";
  std::string behind_test = "on";
  bool border_page = false;
  std::string rounds = "auto";
  std::uint32_t phases = 4;
  std::string lights;
  std::string gpus = "navi21,vega10";
  double precision = 0.05;
  double budget_s = 0.4;
  std::uint32_t seed = 1;
  double cell_timeout_s = 60.0;
  std::vector<std::string> views;
  std::vector<std::string> light_names;
  bool truth = true;
  bool attribution = true;
  bool stability = false;
  bool uncertainty = false;
  int grids = 0;  ///< 1: yes, -1: no, 0: where there are few filters
  bool pictures = true;
  std::string shard;
  bool fresh = false;
  bool yes = false;
  bool strict = false;
  std::string tuned;
  bool worker = false;
  std::string task;  ///< folder of the task of a sweep that is to be done
  std::optional<double> pad_texels;
};

/// Adds the options of `shadowbench run`; parsing fills `arguments`, which must outlive the command.
void add_run_options(Command& command, RunArguments& arguments);

/// Takes what an experiment file says for every option that was not given on the command line. An experiment that names
/// no filters takes those of the default one. Returns the experiment's title. Throws Error as options::read_experiment
/// and options::expand_filters, and Error(kInput) for a value that its option refuses.
std::string apply_experiment(const CommandLine& line, RunArguments& arguments);

}  // namespace shadowbench::cli
