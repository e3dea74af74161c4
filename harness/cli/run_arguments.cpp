#include "harness/cli/run_arguments.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/error.h"
#include "harness/options/experiment_file.h"
#include "harness/tune/tuned_parameters.h"

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
