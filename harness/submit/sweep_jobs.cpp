#include "harness/submit/sweep_jobs.h"

#include <fmt/format.h>

#include <cstring>
#include <new>
#include <string>
#include <vector>

#include "base/error.h"
#include "harness/run/merge.h"
#include "harness/run/run_experiment.h"
#include "harness/submit/sign_of_life.h"
#include "harness/submit/sweep_status.h"
#include "report/files/folder_lock.h"
#include "report/pages/write_report.h"

namespace shadowbench::submit {
namespace {

/// The exit code of a process that a signal ends, as shells say it.
constexpr int kSignalCode = 128;
/// That of a bug.
constexpr int kBug = 70;

}  // namespace

void run_task(options::RunOptions options, const std::filesystem::path& folder, options::Progress& progress) {
  const SweepTask task = read_task(folder);
  const Sweep sweep = read_sweep(options.out);
  options.part = {task.kind == TaskKind::kTruth ? options::Product::kTruth : options::Product::kCells, task.ranges,
                  sweep.scene_cells, task.content};
  remove_failure(folder);
  const SignOfLife alive(folder);
  write_result(folder, run::run_experiment(options, progress));
}

void note_failed_task(const std::filesystem::path& folder, const std::exception& error) {
  const auto* known = dynamic_cast<const Error*>(&error);
  const bool lacks_memory = dynamic_cast<const std::bad_alloc*>(&error) != nullptr;
  const int code = known ? static_cast<int>(known->kind()) : lacks_memory ? static_cast<int>(ErrorKind::kInput) : kBug;
  try {
    if (std::filesystem::exists(folder)) write_failure(folder, {code, lacks_memory ? "memory ran out" : error.what()});
  } catch (const std::exception&) {
    // That it failed is said all the same, where the job prints.
  }
}

void note_stopped_task(const std::filesystem::path& folder, int signal) {
  remove_sign_of_life(folder);
  write_failure(folder, {kSignalCode + signal, fmt::format("stopped by signal {} ({})", signal, strsignal(signal))});
}

void merge_sweep(const std::filesystem::path& out) {
  const SweepStatus status = read_status(out);
  if (!status.is_measured())
    throw Error(ErrorKind::kLimit,
                fmt::format("not all cells are measured, so there is no report yet:\n{}'shadowbench submit' with the "
                            "same words submits what is left",
                            describe_status(status)),
                out.string());
  const files::FolderLock lock(out);
  std::vector<std::string> keys;
  std::vector<records::RunRecord> runs;
  for (const TaskStatus& each : status.tasks) {
    keys.insert(keys.end(), each.task.keys.begin(), each.task.keys.end());
    runs.push_back(read_result(task_folder(out, TaskKind::kCells, each.task.number)));
  }
  for (const TaskStatus& each : status.truths)
    if (each.state == TaskState::kFinished)
      runs.push_back(read_result(task_folder(out, TaskKind::kTruth, each.task.number)));
  records::RunRecord whole = run::join_runs(runs);
  whole.command = status.sweep.command;
  whole.experiment = {status.sweep.title, status.sweep.settings, status.sweep.cells, 1, 1};
  pages::write_report(out, std::move(whole), keys);
}

}  // namespace shadowbench::submit
