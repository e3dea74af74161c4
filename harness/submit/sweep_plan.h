#pragma once

#include <vector>

#include "harness/options/options.h"
#include "harness/submit/sweep_folder.h"

namespace shadowbench::submit {

/// A sweep and all its tasks.
struct SweepPlan {
  Sweep sweep;
  std::vector<SweepTask> truths;
  std::vector<SweepTask> tasks;
};

/// Plans a sweep: lists all cells of the experiment, and splits them into `tasks` tasks, or as many as there are cells;
/// 0: twice the square root of the number of cells, at most 1000, so that few starts are paid for, and many machines
/// have tasks to choose from.
/// Neighbouring views are traced by one task; a view that several fits of the map show is traced once.
/// Throws Error as run::make_plan(). Cost: the loading of all scenes.
SweepPlan plan_sweep(const options::RunOptions& options, int tasks);

/// Splits so many things into stretches whose lengths differ by one at most, none of them empty: `parts`, or as many as
/// there are things. Neighbours in a plan share scene, view and map, so that a stretch of cells sets up few of them.
std::vector<options::CellRange> split_evenly(int things, int parts);

}  // namespace shadowbench::submit
