#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "harness/options/options.h"
#include "report/records/records.h"

namespace shadowbench::submit {

/// What a task of a sweep does.
enum class TaskKind {
  kTruth,  ///< traces what the cells of its views share, into the cache
  kCells,  ///< measures cells
};

/// A task of a sweep: what one job of an array does. Its folder is TRUTH/NUMBER or TASKS/NUMBER in that of the sweep.
struct SweepTask {
  TaskKind kind = TaskKind::kCells;
  int number = 1;  ///< from 1 on
  std::vector<options::CellRange> ranges;
  std::vector<std::string> keys;  ///< of its cells, in the plan's order
  std::string content;            ///< see options::Part
};

/// The jobs that one submission made.
struct SubmittedJobs {
  std::string engine;
  std::string truth, cells, merge;  ///< names of jobs, or a process "12@machine"; empty: there is none
};

/// A sweep as it was submitted.
struct Sweep {
  std::string title;
  std::string settings;              ///< names all its cells; see run::RunPlan
  std::vector<std::string> command;  ///< the command line, one entry per argument
  std::vector<int> scene_cells;      ///< see options::Part
  int cells = 0;
  int truths = 0;  ///< tasks that trace
  int tasks = 0;   ///< tasks that measure
  std::vector<SubmittedJobs> jobs;
};

/// Why a task ended without its cells.
struct TaskFailure {
  int exit_code = 0;
  std::string message;
};

/// The folder of a task: "truth/3" or "tasks/3" in that of the sweep.
std::filesystem::path task_folder(const std::filesystem::path& out, TaskKind kind, int number);

/// Whether a sweep was submitted into a folder.
bool is_sweep(const std::filesystem::path& out);

/// Each file is written whole or not at all. Reading throws Error(kInput) where one is missing or malformed; writing
/// throws Error(kOutput).
void write_sweep(const std::filesystem::path& out, const Sweep& sweep);
Sweep read_sweep(const std::filesystem::path& out);
void write_task(const std::filesystem::path& out, const SweepTask& task);
SweepTask read_task(const std::filesystem::path& folder);

/// What a finished task ran with; written after all its cells. One that cannot be read is none.
void write_result(const std::filesystem::path& folder, const records::RunRecord& run);
bool is_finished(const std::filesystem::path& folder);
records::RunRecord read_result(const std::filesystem::path& folder);

void write_failure(const std::filesystem::path& folder, const TaskFailure& failure);
/// Nothing where the task has not failed.
std::optional<TaskFailure> read_failure(const std::filesystem::path& folder);
void remove_failure(const std::filesystem::path& folder);

}  // namespace shadowbench::submit
