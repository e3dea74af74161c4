#include "harness/submit/submit_sweep.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <system_error>
#include <utility>

#include "base/error.h"
#include "harness/run/run_plan.h"
#include "harness/submit/sign_of_life.h"
#include "harness/submit/sweep_plan.h"
#include "harness/submit/sweep_status.h"
#include "report/files/folder_lock.h"

namespace shadowbench::submit {
namespace {

namespace fs = std::filesystem;

bool has_cells(const fs::path& out) {
  std::error_code error;
  fs::directory_iterator entry(out / "cells", error);
  for (; !error && entry != fs::directory_iterator(); entry.increment(error))
    if (entry->path().extension() == ".json") return true;
  return false;
}

/// Refuses a folder in which cells lie that no task of this sweep has measured.
void require_free(const fs::path& out) {
  std::error_code ignored;
  if (!fs::exists(out / "results.json", ignored) && !has_cells(out)) return;
  throw Error(ErrorKind::kUsage, "--out: there are cells of a run in this folder already; choose an empty or new one",
              out.string());
}

/// Whether a task may have begun: a plan that nobody submitted can be made anew.
bool was_submitted(const fs::path& out) { return is_sweep(out) && (!read_sweep(out).jobs.empty() || has_cells(out)); }

void plan_folder(const options::RunOptions& options, int tasks) {
  require_free(options.out);
  const files::FolderLock lock(options.out, options.force);
  const SweepPlan plan = plan_sweep(options, tasks);
  if (was_submitted(options.out))
    throw Error(ErrorKind::kUsage,
                "--out: meanwhile another 'submit' was given this folder; the same command submits what it leaves",
                options.out.string());
  for (const SweepTask& task : plan.truths) write_task(options.out, task);
  for (const SweepTask& task : plan.tasks) write_task(options.out, task);
  write_sweep(options.out, plan.sweep);  // last: where it is, all tasks are
}

void require_same(options::RunOptions options, const Sweep& sweep) {
  options.fresh = true;
  if (run::make_plan(options, {}).settings == sweep.settings) return;
  throw Error(ErrorKind::kUsage,
              "--out: the sweep in this folder is of another experiment, or of another version of the program: name "
              "the same scenes, filters and settings, or choose another folder",
              options.out.string());
}

/// Those of the tasks that somebody has to do. A job that has printed and shown no sign of life is known by the queue
/// alone: one that was cancelled in its first moments leaves the same.
std::vector<int> list_left(const std::vector<TaskStatus>& tasks, const std::set<int>& queued) {
  std::vector<int> left;
  for (const TaskStatus& each : tasks)
    if (each.state != TaskState::kFinished && !queued.contains(each.task.number)) left.push_back(each.task.number);
  return left;
}

/// Takes those away that have shown lately that they run. Returns what is said of them; empty: there were none.
std::string leave_out_alive(std::vector<int>& left, const std::vector<TaskStatus>& tasks) {
  std::vector<int> alive;
  std::erase_if(left, [&](int number) {
    const bool is_alive = tasks[static_cast<std::size_t>(number - 1)].is_alive;
    if (is_alive) alive.push_back(number);
    return is_alive;
  });
  if (alive.empty()) return {};
  return fmt::format(
      "not submitted, because they showed less than {:.0f} s ago that they run, though they are in no "
      "queue: task {}; once they have ended, or after that time where they were killed, submit again",
      kSilentAfter_s, fmt::join(alive, ", "));
}

std::string count_tasks(const std::vector<int>& tasks) {
  return fmt::format("{} task{}", tasks.size(), tasks.size() == 1 ? "" : "s");
}

std::string describe_tasks(const SweepStatus& status, const std::vector<int>& tasks) {
  std::size_t cells = 0;
  for (const int number : tasks) cells += status.tasks[static_cast<std::size_t>(number - 1)].task.keys.size();
  return fmt::format("{} of {} cell{}", count_tasks(tasks), cells, cells == 1 ? "" : "s");
}

std::string describe_job(const std::string& job) { return job.empty() ? "" : "job " + job + ": "; }

/// What was submitted, or would be where jobs have no names yet.
std::vector<std::string> describe_jobs(const SweepStatus& status, const JobPlan& plan, const SubmittedJobs& jobs) {
  std::vector<std::string> lines;
  if (!plan.truths.empty())
    lines.push_back(fmt::format("{}{} to trace what cells share", describe_job(jobs.truth), count_tasks(plan.truths)));
  if (!plan.tasks.empty()) lines.push_back(describe_job(jobs.cells) + describe_tasks(status, plan.tasks));
  lines.push_back(fmt::format("{}the report, {}", describe_job(jobs.merge), (plan.out / "index.html").string()));
  return lines;
}

/// What tasks left when they ended is of an earlier submission from now on.
void forget_ends(const JobPlan& plan) {
  for (const auto& [kind, numbers] : {std::pair(TaskKind::kTruth, &plan.truths), {TaskKind::kCells, &plan.tasks}}) {
    for (const int number : *numbers) {
      remove_failure(task_folder(plan.out, kind, number));
      remove_sign_of_life(task_folder(plan.out, kind, number));
    }
  }
}

}  // namespace

std::vector<std::string> submit_sweep(const options::RunOptions& options, SubmitRequest request,
                                      options::Progress& progress) {
  const fs::path& out = options.out;
  const std::unique_ptr<Engine> engine = make_engine(request.engine, out);
  if (was_submitted(out)) {
    require_same(options, read_sweep(out));
    if (request.tasks > 0) progress.note("note: --tasks changes nothing: the tasks stay as they were submitted first");
  } else {
    plan_folder(options, request.tasks);
  }
  const QueuedTasks queued = engine->find_queued(out, read_sweep(out).jobs);
  SweepStatus status = read_status(out);  // after that: what ends meanwhile is finished here
  JobPlan& plan = request.jobs;
  plan.tasks = list_left(status.tasks, queued.tasks);
  const std::string alive = leave_out_alive(plan.tasks, status.tasks);
  if (plan.tasks.empty()) {
    if (!alive.empty()) return {alive};
    if (!queued.tasks.empty()) return {"nothing is left to submit: the other tasks are queued or running"};
    if (status.has_report) return {"nothing is left to do"};
  } else {
    plan.truths = list_left(status.truths, queued.truths);  // two may trace the same
    if (!alive.empty()) progress.note("note: " + alive);
  }
  const std::vector<std::string> commands = engine->write_scripts(plan, queued);
  if (request.dry_run) {
    std::vector<std::string> lines = describe_jobs(status, plan, {});
    lines.insert(lines.end(), commands.begin(), commands.end());
    return lines;
  }
  forget_ends(plan);
  const std::vector<SubmittedJobs> earlier = status.sweep.jobs;
  const SubmittedJobs jobs = engine->submit(plan, queued, [&](const SubmittedJobs& made) {
    status.sweep.jobs = earlier;
    if (!made.engine.empty()) status.sweep.jobs.push_back(made);
    write_sweep(out, status.sweep);
  });
  return describe_jobs(status, plan, jobs);
}

}  // namespace shadowbench::submit
