#pragma once

#include "harness/options/options.h"
#include "harness/options/progress.h"
#include "report/records/records.h"

namespace shadowbench::run {

/// The file in a report folder that says that a sweep was submitted into it; see harness/submit.
inline constexpr const char* kSweepFile = "tasks.json";

/// Runs every filter on every scene and writes the report folder. Cells are written as they finish.
/// Returns what is common to its cells; of a part of a sweep nobody else writes that down.
/// Throws Error; what was finished by then stays.
records::RunRecord run_experiment(const options::RunOptions& options, options::Progress& progress);

}  // namespace shadowbench::run
