#pragma once

#include "harness/options/options.h"

namespace shadowbench::run {

/// Runs every filter on every scene and writes the report folder. Cells are written as they finish.
/// Throws Error; what was finished by then stays.
void run_experiment(const options::RunOptions& options, options::Progress& progress);

}  // namespace shadowbench::run
