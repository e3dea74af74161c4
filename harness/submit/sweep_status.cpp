#include "harness/submit/sweep_status.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>
#include <system_error>

#include "harness/submit/sign_of_life.h"
#include "report/records/json_io.h"
#include "report/records/json_values.h"

namespace shadowbench::submit {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr std::array<const char*, kTaskStates> kNames = {"finished", "running", "failed", "lost", "waiting"};
/// Of so many tasks a message is shown; the others' are in their folders.
constexpr int kShownMessages = 10;

/// Looks at the files of tasks.
class StatusReader {
 public:
  StatusReader(const fs::path& out, double silent_after_s)
      : out_(out), silent_after_s_(silent_after_s), now_(file_system_now(out)), submitted_(find_submission(out)) {}

  TaskStatus read(TaskKind kind, int number) const {
    const fs::path folder = task_folder(out_, kind, number);
    TaskStatus status{.task = read_task(folder), .message = {}};
    status.cells = static_cast<int>(std::ranges::count_if(status.task.keys, [&](const std::string& key) {
      std::error_code ignored;
      return fs::exists(records::cell_path(out_, key), ignored);
    }));
    const bool has_all = status.cells == static_cast<int>(status.task.keys.size());
    const bool wrote_result = is_finished(folder);
    if (has_all && wrote_result) {
      status.state = TaskState::kFinished;
    } else if (const auto sign = read_last_sign(folder, now_)) {
      status.is_alive = !sign->is_gone && sign->silent_s < silent_after_s_;
      status.state = status.is_alive ? TaskState::kRunning : TaskState::kLost;
      if (sign->is_gone)
        status.message = "its process has ended without a word; see its log.txt";
      else if (!status.is_alive)
        status.message = fmt::format("it has shown nothing for {:.0f} s; see its log.txt", sign->silent_s);
    } else if (const auto failure = read_failure(folder)) {
      status.state = TaskState::kFailed;
      status.message = fmt::format("exit code {}: {}", failure->exit_code, failure->message);
    } else if (const auto log = read_log_silence(folder); log && !wrote_result) {
      status.state = *log < silent_after_s_ ? TaskState::kRunning : TaskState::kLost;
      status.message = status.state == TaskState::kLost
                           ? "it ended without a word; see its log.txt"
                           : "its job has printed, and no process of it has shown itself yet; see its log.txt";
    } else if (wrote_result) {
      status.state = TaskState::kLost;
      status.message = fmt::format("it was finished, and {} of its cells are gone",
                                   status.task.keys.size() - static_cast<std::size_t>(status.cells));
    }
    return status;
  }

 private:
  const fs::path& out_;
  double silent_after_s_;
  fs::file_time_type now_;
  fs::file_time_type submitted_;

  /// When the scripts were last written, which is before their jobs begin.
  static fs::file_time_type find_submission(const fs::path& out) {
    fs::file_time_type last = fs::file_time_type::min();
    for (const char* script : {"submit.sbatch", "submit.sh"}) {
      std::error_code missing;
      const fs::file_time_type time = fs::last_write_time(out / script, missing);
      if (!missing) last = std::max(last, time);
    }
    return last;
  }

  /// How long a job has printed nothing; nothing where it has not printed since it was submitted.
  std::optional<double> read_log_silence(const fs::path& folder) const {
    std::error_code missing;
    const fs::file_time_type last = fs::last_write_time(folder / "log.txt", missing);
    if (missing || last < submitted_ || fs::file_size(folder / "log.txt", missing) == 0) return std::nullopt;
    return std::chrono::duration<double>(now_ - last).count();
  }
};

struct Count {
  int truths = 0, tasks = 0, cells = 0;
};

std::array<Count, kTaskStates> count_states(const SweepStatus& status) {
  std::array<Count, kTaskStates> counts{};
  for (const TaskStatus& each : status.truths) ++counts[static_cast<std::size_t>(each.state)].truths;
  for (const TaskStatus& each : status.tasks) {
    Count& count = counts[static_cast<std::size_t>(each.state)];
    ++count.tasks;
    count.cells += static_cast<int>(each.task.keys.size());
  }
  return counts;
}

int count_measured(const SweepStatus& status) {
  int cells = 0;
  for (const TaskStatus& each : status.tasks) cells += each.cells;
  return cells;
}

json task_json(const TaskStatus& status) {
  return {{"task", status.task.number},
          {"state", name_of(status.state)},
          {"cells", status.task.keys.size()},
          {"measured", status.cells},
          {"message", status.message}};
}

}  // namespace

const char* name_of(TaskState state) { return kNames[static_cast<std::size_t>(state)]; }

bool SweepStatus::is_measured() const {
  return std::ranges::all_of(
      tasks, [](const TaskStatus& each) { return each.state == TaskState::kFinished; });
}

SweepStatus read_status(const fs::path& out, double silent_after_s) {
  SweepStatus status{.sweep = read_sweep(out), .truths = {}, .tasks = {}};
  const StatusReader reader(out, silent_after_s);
  for (int i = 1; i <= status.sweep.truths; ++i) status.truths.push_back(reader.read(TaskKind::kTruth, i));
  for (int i = 1; i <= status.sweep.tasks; ++i) status.tasks.push_back(reader.read(TaskKind::kCells, i));
  std::error_code ignored;
  status.has_report = fs::exists(out / "results.json", ignored);
  return status;
}

std::string describe_status(const SweepStatus& status) {
  const std::array<Count, kTaskStates> counts = count_states(status);
  std::string text = fmt::format("{:<10}{:>8}{:>8}{:>8}\n", "", "truth", "tasks", "cells");
  for (std::size_t i = 0; i < kTaskStates; ++i)
    text += fmt::format("{:<10}{:>8}{:>8}{:>8}\n", kNames[i], counts[i].truths, counts[i].tasks, counts[i].cells);
  text += fmt::format("{} of {} cells are measured; {}\n", count_measured(status), status.sweep.cells,
                      status.has_report      ? "the report is written"
                      : status.is_measured() ? "the report is not written: 'shadowbench merge' with this folder does it"
                                             : "there is no report yet");
  int shown = 0;
  for (const auto* list : {&status.truths, &status.tasks}) {
    for (const TaskStatus& each : *list) {
      if (each.message.empty() || ++shown > kShownMessages) continue;
      text += fmt::format("{} {} {}: {}\n", each.task.kind == TaskKind::kTruth ? "truth" : "task", each.task.number,
                          name_of(each.state), each.message);
    }
  }
  if (shown > kShownMessages) text += fmt::format("and {} more\n", shown - kShownMessages);
  return text;
}

std::string make_status_json(const SweepStatus& status) {
  json truths = json::array(), tasks = json::array();
  for (const TaskStatus& each : status.truths) truths.push_back(task_json(each));
  for (const TaskStatus& each : status.tasks) tasks.push_back(task_json(each));
  return records::dump_line({{"cells", status.sweep.cells},
                             {"measured", count_measured(status)},
                             {"report", status.has_report},
                             {"truths", truths},
                             {"tasks", tasks}}) +
         "\n";
}

}  // namespace shadowbench::submit
