#pragma once

#include <functional>
#include <vector>

#include "harness/options/options.h"
#include "harness/options/progress.h"
#include "harness/submit/sweep_folder.h"

namespace shadowbench::submit {

/// How a sweep is to be split.
struct SplitRule {
  int tasks = 0;                      ///< 0: so many that each takes about ten minutes
  std::filesystem::path earlier_run;  ///< a report folder whose cells say what cells take; empty: a probe says it
  bool probe = true;                  ///< measure some cells first where no earlier run says what they take
};

/// A sweep and all its tasks.
struct SweepPlan {
  Sweep sweep;
  std::vector<SweepTask> truths;
  std::vector<SweepTask> tasks;
};

/// Plans a sweep: lists all cells of the experiment, expects what they take, and splits them into tasks.
/// Neighbouring views are traced by one task; a view that several fits of the map show is traced once.
/// Throws Error as run::make_plan(), and Error(kInput) where the earlier run cannot be read. Cost: the loading of all
/// scenes, and of a probe the time of at most two cells of every filter.
SweepPlan plan_sweep(const options::RunOptions& options, const SplitRule& rule, options::Progress& progress);

}  // namespace shadowbench::submit
