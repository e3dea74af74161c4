#include "harness/submit/sweep_folder.h"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <nlohmann/json.hpp>
#include <system_error>

#include "base/atomic_file.h"
#include "base/error.h"
#include "base/input_file.h"
#include "harness/run/run_experiment.h"
#include "report/records/json_io.h"
#include "report/records/json_values.h"

/// A range of cells is a list of its two ends.
template <>
struct nlohmann::adl_serializer<shadowbench::options::CellRange> {
  static void to_json(json& to, const shadowbench::options::CellRange& range) { to = {range.begin, range.end}; }
  static void from_json(const json& from, shadowbench::options::CellRange& range) { range = {from.at(0), from.at(1)}; }
};

namespace shadowbench::submit {

NLOHMANN_JSON_SERIALIZE_ENUM(TaskKind, {{TaskKind::kCells, "tasks"}, {TaskKind::kTruth, "truth"}})
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(SweepTask, kind, number, ranges, keys, content)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(SubmittedJobs, engine, truth, cells, merge)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Sweep, title, settings, command, scene_cells, cells, truths, tasks, jobs)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(TaskFailure, exit_code, message)

namespace {

namespace fs = std::filesystem;
using nlohmann::json;

/// Version of all files of a sweep.
constexpr int kSchemaVersion = 1;
constexpr const char *kTaskFile = "task.json", *kResultFile = "result.json", *kFailureFile = "failure.json";

void write_json(const fs::path& file, json content) {
  content["schema_version"] = kSchemaVersion;
  write_text_file(file, records::dump_line(content) + "\n");
}

/// Reads a file with `read`, and says of any mistake in it where it is.
template <class Read>
auto read_json(const fs::path& file, const Read& read) {
  require_plain_file(file, 1024 * kMebibyte);
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

template <class T>
T read_as(const fs::path& file) {
  return read_json(
      file, [](const json& content) { return content.get<T>(); });
}

/// Refuses names of jobs that no engine gives: their programs take them as words, and a folder may be of somebody else.
/// A name is a number, perhaps with ';' or '@' and where the job is.
void require_job_names(const SubmittedJobs& jobs) {
  constexpr const char* kDigits = "0123456789";
  for (const std::string& job : {jobs.truth, jobs.cells, jobs.merge}) {
    const std::size_t end = job.find_first_of(";@");
    if (!job.empty() && (end == 0 || job.find_first_not_of(kDigits) != end))
      throw std::invalid_argument(fmt::format("it names a job '{}', which is no number", job));
  }
}

bool is_there(const fs::path& file) {
  std::error_code ignored;
  return fs::exists(file, ignored);
}

}  // namespace

fs::path task_folder(const fs::path& out, TaskKind kind, int number) {
  return out / json(kind).get<std::string>() / std::to_string(number);
}

bool is_sweep(const fs::path& out) { return is_there(out / run::kSweepFile); }

void write_sweep(const fs::path& out, const Sweep& sweep) { write_json(out / run::kSweepFile, sweep); }

Sweep read_sweep(const fs::path& out) {
  return read_json(
      out / run::kSweepFile,
      [](const json& content) {
        auto sweep = content.get<Sweep>();
        std::ranges::for_each(sweep.jobs, require_job_names);
        return sweep;
      });
}

void write_task(const fs::path& out, const SweepTask& task) {
  write_json(task_folder(out, task.kind, task.number) / kTaskFile, task);
}

SweepTask read_task(const fs::path& folder) { return read_as<SweepTask>(folder / kTaskFile); }

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

void write_failure(const fs::path& folder, const TaskFailure& failure) { write_json(folder / kFailureFile, failure); }

std::optional<TaskFailure> read_failure(const fs::path& folder) {
  if (!is_there(folder / kFailureFile)) return std::nullopt;
  return read_as<TaskFailure>(folder / kFailureFile);
}

void remove_failure(const fs::path& folder) {
  std::error_code ignored;
  fs::remove(folder / kFailureFile, ignored);
}

}  // namespace shadowbench::submit
