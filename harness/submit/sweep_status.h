#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "harness/submit/sweep_folder.h"

namespace shadowbench::submit {

/// What the files of a task say of it.
enum class TaskState {
  kFinished,
  kRunning,  ///< it has shown lately that it runs, or its job has printed lately and may yet begin it
  kFailed,   ///< it said why
  kLost,     ///< it ran, and has long shown nothing: its machine is gone, or it was killed
  kWaiting   ///< it has not begun
};
inline constexpr std::size_t kTaskStates = static_cast<std::size_t>(TaskState::kWaiting) + 1;

/// The name of a state: "finished".
const char* name_of(TaskState state);

struct TaskStatus {
  SweepTask task;
  TaskState state = TaskState::kWaiting;
  int cells = 0;          ///< that it has measured
  bool is_alive = false;  ///< it has shown lately that it runs
  std::string message;    ///< why it failed or is lost, or runs without a sign; else empty
};

struct SweepStatus {
  Sweep sweep;
  std::vector<TaskStatus> truths;
  std::vector<TaskStatus> tasks;
  bool has_report = false;

  /// Whether every cell is there.
  bool is_measured() const;
};

/// A task that has shown nothing for so long is taken for lost. Network file systems show the time of a file up to a
/// minute late.
inline constexpr double kSilentAfter_s = 120.0;

/// Reads how far a sweep is, from its files alone. Ages are taken by the clock of the file system.
/// Throws Error(kInput) where no sweep was submitted into the folder, or a file of it is damaged.
SweepStatus read_status(const std::filesystem::path& out, double silent_after_s = kSilentAfter_s);

/// A table for people, and a line for each of the first tasks that have a message.
std::string describe_status(const SweepStatus& status);

/// The same for programs.
std::string make_status_json(const SweepStatus& status);

}  // namespace shadowbench::submit
