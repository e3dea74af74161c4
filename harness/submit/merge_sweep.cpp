#include "harness/submit/merge_sweep.h"

#include <fmt/format.h>

#include <string>
#include <vector>

#include "filters/base/error.h"
#include "harness/run/merge.h"
#include "harness/submit/sweep_folder.h"
#include "harness/submit/sweep_status.h"
#include "report/files/folder_lock.h"
#include "report/pages/write_report.h"

namespace shadowbench::submit {

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
