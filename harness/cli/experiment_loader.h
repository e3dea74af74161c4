#pragma once

#include "harness/run/options.h"
#include "harness/run/progress.h"

namespace shadowbench::cli {

/// Loads the module with everything that draws and writes, which lies beside the program, and runs an experiment in it.
/// Throws Error as run::run_experiment, and Error(kUsage) when the module is missing.
void load_and_run_experiment(const run::RunOptions& options, run::Progress& progress);

}  // namespace shadowbench::cli
