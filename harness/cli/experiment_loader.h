#pragma once

#include <filesystem>
#include <vector>

#include "harness/flicker/run_flicker.h"
#include "harness/run/compare_pictures.h"
#include "harness/run/options.h"
#include "harness/run/progress.h"
#include "harness/run/tune_filters.h"
#include "harness/stress/run_stress.h"
#include "report/regress/regress.h"

namespace shadowbench::cli {

// All load the module with everything that draws, reads and writes pictures, which lies beside the program, and throw
// Error(kUsage) when it is missing.

/// Runs an experiment. Throws Error as run::run_experiment.
void load_and_run_experiment(const run::RunOptions& options, run::Progress& progress);

/// Sweeps the modes of bias. Throws Error as run::run_bias_sweep.
void load_and_run_bias_sweep(const run::RunOptions& options, run::Progress& progress);

/// Joins shards. Throws Error as report::merge_runs.
void load_and_merge_runs(const std::vector<std::filesystem::path>& folders, const std::filesystem::path& out);

/// Tunes filters; gives the text of tune.md. Throws Error as run::tune_filters.
std::string load_and_tune_filters(const run::TuneOptions& options, run::Progress& progress);

/// Drives filters along the axes of `stress`. Throws Error as stress::run_stress.
stress::StressOutcome load_and_run_stress(const stress::StressOptions& options, run::Progress& progress);

/// Lists the axes of `stress`, for people.
std::string load_and_describe_stress_axes(const std::vector<filters::FilterRequest>& filters);

/// Measures flicker. Throws Error as flicker::run_flicker.
void load_and_run_flicker(const flicker::FlickerOptions& options, run::Progress& progress);

/// Compares a run with a baseline. Throws Error as regress::run_regress.
regress::RegressOutcome load_and_run_regress(const regress::RegressOptions& options);

/// Compares two pictures. Throws Error as run::compare_pictures.
run::Comparison load_and_compare_pictures(const run::ComparisonOptions& options);

}  // namespace shadowbench::cli
