#pragma once

#include <exception>
#include <filesystem>

#include "harness/options/options.h"
#include "harness/options/progress.h"

namespace shadowbench::submit {

/// Does a task of a sweep: measures those of its cells that are not there, or traces, and writes beside its plan what
/// it ran with. Shows meanwhile that it runs. May be started again at any time, also while it runs elsewhere. `options`
/// are those of the whole experiment.
/// Throws Error as run::run_experiment(), and Error(kInput) where the folder holds no task, or the experiment, a filter
/// or the program is no longer what was submitted.
void run_task(options::RunOptions options, const std::filesystem::path& folder, options::Progress& progress);

/// Notes why a task failed. Whoever reads its words does it, because they may be what is wrong.
void note_failed_task(const std::filesystem::path& folder, const std::exception& error);

/// Notes that a signal ends a task.
void note_stopped_task(const std::filesystem::path& folder, int signal);

/// Writes the report of a sweep whose tasks are all finished, of the cells that they left in its folder; it equals that
/// of one run of the whole experiment in everything but times, load and work done.
/// Throws Error(kLimit) where cells are missing; nothing is written then. Throws Error(kInput) where no sweep was
/// submitted into the folder, Error(kOutput). Cost: no picture is read or copied.
void merge_sweep(const std::filesystem::path& out);

}  // namespace shadowbench::submit
