#include "harness/submit/sweep_folder.h"

#include <fmt/format.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <system_error>

#include "filters/base/atomic_file.h"
#include "filters/base/error.h"
#include "filters/base/input_file.h"
#include "harness/run/run_experiment.h"
#include "report/records/json_io.h"
#include "report/records/json_values.h"

namespace shadowbench::submit {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

/// Version of all files of a sweep.
constexpr int kSchemaVersion = 1;
constexpr const char *kTaskFile = "task.json", *kResultFile = "result.json", *kFailureFile = "failure.json";

const char* name_of(TaskKind kind) { return kind == TaskKind::kTruth ? "truth" : "tasks"; }

void write_json(const fs::path& file, json content) {
  content["schema_version"] = kSchemaVersion;
  write_text_file(file, records::dump_line(content) + "\n");
}

/// Reads a file with `read`, and says of any mistake in it where it is.
template <class Read>
auto read_json(const fs::path& file, const Read& read) {
  std::ifstream stream(file);
  if (!stream)
    throw Error(ErrorKind::kInput, "this file is missing or cannot be read: no sweep was submitted into this folder",
                file.string());
  try {
    const json content = records::parse_json(stream);
    if (content.at("schema_version") != kSchemaVersion)
      throw Error(ErrorKind::kInput, "it was written by another version of the program; submit it anew", file.string());
    return read(content);
  } catch (const json::exception& error) {
    throw Error(ErrorKind::kInput, fmt::format("it is damaged ({}); submit the sweep anew", error.what()),
                file.string());
  } catch (const std::invalid_argument& error) {
    throw Error(ErrorKind::kInput, fmt::format("it is damaged ({}); submit the sweep anew", error.what()),
                file.string());
  }
}

bool is_there(const fs::path& file) {
  std::error_code ignored;
  return fs::exists(file, ignored);
}

}  // namespace

fs::path task_folder(const fs::path& out, TaskKind kind, int number) {
  return out / name_of(kind) / std::to_string(number);
}

bool is_sweep(const fs::path& out) { return is_there(out / run::kSweepFile); }

void write_sweep(const fs::path& out, const Sweep& sweep) {
  json jobs = json::array();
  for (const SubmittedJobs& each : sweep.jobs)
    jobs.push_back({{"engine", each.engine}, {"truth", each.truth}, {"cells", each.cells}, {"merge", each.merge}});
  write_json(out / run::kSweepFile, {{"title", sweep.title},
                                     {"settings", sweep.settings},
                                     {"command", sweep.command},
                                     {"scene_cells", sweep.scene_cells},
                                     {"cells", sweep.cells},
                                     {"truths", sweep.truths},
                                     {"tasks", sweep.tasks},
                                     {"jobs", jobs}});
}

Sweep read_sweep(const fs::path& out) {
  return read_json(
      out / run::kSweepFile,
      [](const json& content) {
        Sweep sweep{.title = content.at("title"),
                    .settings = content.at("settings"),
                    .command = content.at("command"),
                    .scene_cells = content.at("scene_cells"),
                    .cells = content.at("cells"),
                    .truths = content.at("truths"),
                    .tasks = content.at("tasks"),
                    .jobs = {}};
        for (const json& each : content.at("jobs"))
          sweep.jobs.push_back({each.at("engine"), each.at("truth"), each.at("cells"), each.at("merge")});
        return sweep;
      });
}

void write_task(const fs::path& out, const SweepTask& task) {
  json ranges = json::array();
  for (const options::CellRange& range : task.ranges) ranges.push_back({range.begin, range.end});
  write_json(task_folder(out, task.kind, task.number) / kTaskFile, {{"kind", name_of(task.kind)},
                                                                    {"number", task.number},
                                                                    {"ranges", ranges},
                                                                    {"keys", task.keys},
                                                                    {"content", task.content},
                                                                    {"seconds", task.seconds}});
}

SweepTask read_task(const fs::path& folder) {
  return read_json(
      folder / kTaskFile,
      [](const json& content) {
        SweepTask task{.kind = content.at("kind") == name_of(TaskKind::kTruth) ? TaskKind::kTruth : TaskKind::kCells,
                       .number = content.at("number"),
                       .ranges = {},
                       .keys = content.at("keys"),
                       .content = content.at("content"),
                       .seconds = content.at("seconds")};
        for (const json& range : content.at("ranges")) task.ranges.push_back({range.at(0), range.at(1)});
        return task;
      });
}

void write_result(const fs::path& folder, const records::RunRecord& run) {
  write_json(folder / kResultFile, {{"run", records::to_json(run)}});
}

bool is_finished(const fs::path& folder) {
  if (!is_there(folder / kResultFile)) return false;
  try {
    read_result(folder);
    return true;
  } catch (const Error&) {
    return false;
  }
}

records::RunRecord read_result(const fs::path& folder) {
  const fs::path file = folder / kResultFile;
  return read_json(file, [&](const json& content) { return records::run_from_json(content.at("run"), file.string()); });
}

void write_failure(const fs::path& folder, const TaskFailure& failure) {
  write_json(folder / kFailureFile, {{"exit_code", failure.exit_code}, {"message", failure.message}});
}

std::optional<TaskFailure> read_failure(const fs::path& folder) {
  if (!is_there(folder / kFailureFile)) return std::nullopt;
  return read_json(folder / kFailureFile, [](const json& content) {
    return TaskFailure{content.at("exit_code"), content.at("message")};
  });
}

void remove_failure(const fs::path& folder) {
  std::error_code ignored;
  fs::remove(folder / kFailureFile, ignored);
}

}  // namespace shadowbench::submit
