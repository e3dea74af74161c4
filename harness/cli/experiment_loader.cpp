#include "harness/cli/experiment_loader.h"

#include <dlfcn.h>
#include <fmt/format.h>

#include <filesystem>

#include "filters/error.h"

namespace shadowbench::cli {
namespace {

/// Gives an entry of the module, which is never closed: exceptions and GL drivers keep pointers into it.
template <class Function>
Function* load_entry(const char* name) {
  const auto module = std::filesystem::read_symlink("/proc/self/exe").parent_path() / "shadowbench_experiment.so";
  void* handle = dlopen(module.c_str(), RTLD_NOW | RTLD_LOCAL);
  void* entry = handle ? dlsym(handle, name) : nullptr;
  if (!entry)
    throw Error(ErrorKind::kUsage, fmt::format("cannot load a part of the program: {}; build it again", dlerror()));
  return reinterpret_cast<Function*>(entry);
}

}  // namespace

void load_and_run_experiment(const run::RunOptions& options, run::Progress& progress) {
  load_entry<void(const run::RunOptions&, run::Progress&)>("shadowbench_run_experiment")(options, progress);
}

void load_and_run_bias_sweep(const run::RunOptions& options, run::Progress& progress) {
  load_entry<void(const run::RunOptions&, run::Progress&)>("shadowbench_run_bias_sweep")(options, progress);
}

void load_and_merge_runs(const std::vector<std::filesystem::path>& folders, const std::filesystem::path& out) {
  load_entry<void(const std::vector<std::filesystem::path>&, const std::filesystem::path&)>("shadowbench_merge_runs")(
      folders, out);
}

std::string load_and_tune_filters(const run::TuneOptions& options, run::Progress& progress) {
  std::string text;
  load_entry<void(const run::TuneOptions&, run::Progress&, std::string&)>("shadowbench_tune_filters")(options, progress,
                                                                                                      text);
  return text;
}

stress::StressOutcome load_and_run_stress(const stress::StressOptions& options, run::Progress& progress) {
  stress::StressOutcome outcome;
  load_entry<void(const stress::StressOptions&, run::Progress&, stress::StressOutcome&)>("shadowbench_run_stress")(
      options, progress, outcome);
  return outcome;
}

std::string load_and_describe_stress_axes(const std::vector<filters::FilterRequest>& filters) {
  std::string text;
  load_entry<void(const std::vector<filters::FilterRequest>&, std::string&)>("shadowbench_describe_stress_axes")(
      filters, text);
  return text;
}

void load_and_run_flicker(const flicker::FlickerOptions& options, run::Progress& progress) {
  load_entry<void(const flicker::FlickerOptions&, run::Progress&)>("shadowbench_run_flicker")(options, progress);
}

regress::RegressOutcome load_and_run_regress(const regress::RegressOptions& options) {
  regress::RegressOutcome outcome;
  load_entry<void(const regress::RegressOptions&, regress::RegressOutcome&)>("shadowbench_run_regress")(options,
                                                                                                        outcome);
  return outcome;
}

run::Comparison load_and_compare_pictures(const run::ComparisonOptions& options) {
  run::Comparison result;
  load_entry<void(const run::ComparisonOptions&, run::Comparison&)>("shadowbench_compare_pictures")(options, result);
  return result;
}

}  // namespace shadowbench::cli
