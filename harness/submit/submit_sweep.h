#pragma once

#include <string>
#include <vector>

#include "harness/options/options.h"
#include "harness/options/progress.h"
#include "harness/submit/engine.h"

namespace shadowbench::submit {

/// What the user asks of a submission.
struct SubmitRequest {
  EngineOptions engine;
  int tasks = 0;         ///< into how many to split; 0: see plan_sweep()
  JobPlan jobs;          ///< but for its tasks
  bool dry_run = false;  ///< write the scripts, and submit nothing
};

/// Submits a sweep into its folder, or, where it was submitted before, what is neither finished, nor running, nor
/// queued. Two of its tasks on one cell do no harm: each file is written whole, and the last one stays.
/// Returns what was submitted, a line each. Throws Error(kUsage) where the folder holds something else, or the engine
/// refuses: nothing is queued then, and the same command goes on. Throws Error as plan_sweep().
std::vector<std::string> submit_sweep(const options::RunOptions& options, SubmitRequest request,
                                      options::Progress& progress);

}  // namespace shadowbench::submit
