#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <chrono>
#include <cstring>
#include <sstream>
#include <thread>

#include "base/atomic_file.h"
#include "base/error.h"
#include "harness/submit/engine.h"

namespace shadowbench::submit {
namespace {

namespace fs = std::filesystem;

constexpr const char *kTruthScript = "truth.sbatch", *kCellScript = "submit.sbatch", *kMergeScript = "merge.sbatch";
constexpr int kNoSuchCommand = 127;
/// For so many seconds jobs that are ending are waited for. Slurm kills them after 30, unless it is told otherwise.
constexpr int kMostTries = 40;

/// What no line of options may hold: sbatch has no way to say it.
constexpr const char* kUnquotable = "\"\\\n";

/// A name without what no line of options may hold.
std::string plain(std::string name) {
  for (char& c : name)
    if (std::strchr(kUnquotable, c)) c = '_';
  return name;
}

/// Writes numbers as Slurm takes those of an array: "1-3,7".
std::string describe_array(const std::vector<int>& numbers) {
  std::string text;
  for (std::size_t i = 0; i < numbers.size();) {
    std::size_t last = i;
    while (last + 1 < numbers.size() && numbers[last + 1] == numbers[last] + 1) ++last;
    text += fmt::format("{}{}", text.empty() ? "" : ",", numbers[i]);
    if (last > i) text += fmt::format("-{}", numbers[last]);
    i = last + 1;
  }
  return text;
}

/// Writes a path for a line of options, where '%' begins a pattern, and a pattern after it.
std::string quote_pattern(const fs::path& path, const std::string& pattern = {}) {
  std::string text;
  for (const char c : path.string()) text += c == '%' ? "%%" : std::string(1, c);
  return "\"" + text + pattern + "\"";
}

class SlurmEngine : public Engine {
 public:
  explicit SlurmEngine(const EngineOptions& options) : options_(options) {
    for (const std::string& word : options.words)
      for (const std::string own : {"--array", "-a", "--dependency", "-d", "--output", "-o", "--wrap"})
        if (word == own || word.starts_with(own.size() == 2 ? own : own + "="))
          throw Error(ErrorKind::kUsage,
                      fmt::format("-- {}: that is submit's own, to have each task once and in order; leave it out "
                                  "('scontrol update job=ID arraytaskthrottle=N' limits how many run at once)",
                                  own));
  }

  QueuedTasks find_queued(const fs::path&, const std::vector<SubmittedJobs>& earlier) override {
    QueuedTasks queued;
    for (const SubmittedJobs& jobs : earlier) {
      if (jobs.engine != options_.engine) continue;
      std::set<int> truths = list_array(jobs.truth), tasks = list_array(jobs.cells);
      if (truths.empty() && tasks.empty()) continue;
      queued.jobs.push_back(
          {jobs.engine, truths.empty() ? "" : jobs.truth, tasks.empty() ? "" : jobs.cells, jobs.merge});
      queued.truths.merge(truths);
      queued.tasks.merge(tasks);
    }
    return queued;
  }

  std::vector<std::string> write_scripts(const JobPlan& plan, const QueuedTasks& queued) override {
    if (!plan.truths.empty())
      write_array(plan, kTruthScript, "Traces what cells share, once, into the cache that all tasks read.",
                  TaskKind::kTruth, plan.truths);
    if (!plan.tasks.empty())
      write_array(plan, kCellScript, "Measures the cells of a sweep: each element of the array those of one task.",
                  TaskKind::kCells, plan.tasks);
    write_merge(plan);
    return list_commands(plan, queued, {"", "TRUTH", "CELLS", ""});
  }

  SubmittedJobs submit(const JobPlan& plan, const QueuedTasks& queued, const NoteJobs& note) override {
    SubmittedJobs jobs{options_.engine, {}, {}, {}};
    const auto make = [&](std::string& job, const std::string& command) {
      job = run_sbatch(command);
      note(jobs);
    };
    try {
      if (!plan.truths.empty()) make(jobs.truth, truth_command(plan));
      if (!plan.tasks.empty()) make(jobs.cells, cell_command(plan, queued, jobs.truth));
      make(jobs.merge, merge_command(plan, queued, jobs.cells));
    } catch (const Error&) {
      cancel(jobs.truth);
      cancel(jobs.cells);
      note({});
      throw;
    }
    for (const SubmittedJobs& each : queued.jobs) cancel(each.merge);  // it would be early
    return jobs;
  }

 private:
  EngineOptions options_;

  /// The number of a job, which sbatch writes before a ';' and its cluster's name.
  static std::string number_of(const std::string& job) { return job.substr(0, job.find(';')); }

  /// A program of Slurm that is asked about a job, with what says where the job is.
  static std::vector<std::string> address(const char* program, const std::string& job) {
    std::vector<std::string> words = {program};
    if (const std::size_t end = job.find(';'); end != std::string::npos)
      words.push_back("--clusters=" + job.substr(end + 1));
    return words;
  }

  static void cancel(const std::string& job) {
    if (job.empty()) return;
    std::vector<std::string> words = address("scancel", job);
    words.push_back(number_of(job));
    run_shell(quote_words(words));
  }

  /// The numbers of an array's elements that are not done; none where Slurm has forgotten the job. Those that are
  /// ending may be cancelled or go back to the queue: they are waited for.
  static std::set<int> list_array(const std::string& job) {
    if (job.empty()) return {};
    std::vector<std::string> words = address("squeue", job);
    words.insert(words.end(), {"--noheader", "--array", "--format=%K %T", "--jobs", number_of(job)});
    for (int tries = 0;; ++tries) {
      const ShellOutcome outcome = run_shell(quote_words(words));
      const bool is_forgotten = outcome.text.find("Invalid job id") != std::string::npos;
      if (is_forgotten || outcome.exit_code == kNoSuchCommand) return {};
      if (outcome.exit_code != 0)
        throw Error(ErrorKind::kUsage,
                    fmt::format("squeue refuses, so nobody can say which tasks wait: {}; try again once "
                                "Slurm answers",
                                outcome.text));
      if (tries == kMostTries || outcome.text.find(" COMPLETING") == std::string::npos)
        return read_elements(outcome.text);
      std::this_thread::sleep_for(std::chrono::seconds(1));
    }
  }

  /// The numbers with which lines begin; warnings may stand among them.
  static std::set<int> read_elements(const std::string& text) {
    std::set<int> numbers;
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);) {
      std::istringstream words(line);
      int number = 0;
      std::string state, more;
      if (words >> number >> state && !(words >> more)) numbers.insert(number);
    }
    return numbers;
  }

  std::string describe_resources(bool whole_node) const {
    std::string lines;
    if (whole_node) lines += "#SBATCH --exclusive\n";  // beside other work, times would be of that work too
    if (!options_.time.empty()) lines += "#SBATCH --time=" + options_.time + "\n";
    if (!options_.gres.empty()) lines += "#SBATCH --gres=" + options_.gres + "\n";
    if (!options_.partition.empty()) lines += "#SBATCH --partition=" + options_.partition + "\n";
    return lines;
  }

  /// Slurm's own --chdir goes on in /tmp where there is no such folder.
  static std::string enter_folder(const JobPlan& plan) {
    return "cd " + quote_words({plan.working_folder.string()}) + " || exit 1\n";
  }

  void write_array(const JobPlan& plan, const char* script, const char* what, TaskKind kind,
                   const std::vector<int>& numbers) const {
    const fs::path folder = task_folder(plan.out, kind, 1).parent_path();
    write_text_file(
        plan.out / script,
        fmt::format("#!/bin/sh\n# {}\n# Written by 'shadowbench submit'. Stopped or requeued, a task goes on where it "
                    "was.\n"
                    "#SBATCH --job-name=\"{}-{}\"\n#SBATCH --array={}\n#SBATCH --output={}\n#SBATCH "
                    "--open-mode=append\n#SBATCH --requeue\n{}\n{}exec {} --task {}/\"$SLURM_ARRAY_TASK_ID\"\n",
                    what, plain(plan.name), folder.filename().string(), describe_array(numbers),
                    quote_pattern(folder, "/%a/log.txt"), describe_resources(true), enter_folder(plan),
                    quote_words(plan.command), quote_words({folder.string()})));
  }

  void write_merge(const JobPlan& plan) const {
    std::vector<std::string> command = plan.program;
    command.insert(command.end(), {"merge", plan.out.string()});
    write_text_file(plan.out / kMergeScript,
                    fmt::format("#!/bin/sh\n# Writes the report once no task runs any more.\n# Written by 'shadowbench "
                                "submit'.\n#SBATCH --job-name=\"{}-merge\"\n#SBATCH --output={}\n#SBATCH "
                                "--open-mode=append\n{}\n{}exec {}\n",
                                plain(plan.name), quote_pattern(plan.out / "merge.log"), describe_resources(false),
                                enter_folder(plan), quote_words(command)));
  }

  std::string make_command(const JobPlan& plan, const std::vector<std::string>& options, const char* script) const {
    std::vector<std::string> words = {"sbatch"};
    words.insert(words.end(), options_.words.begin(), options_.words.end());
    words.push_back("--parsable");
    words.insert(words.end(), options.begin(), options.end());
    words.push_back((plan.out / script).string());
    return quote_words(words);
  }

  std::string truth_command(const JobPlan& plan) const { return make_command(plan, {}, kTruthScript); }

  /// Cells wait for all truth, and are not begun where that fails: what fails there would fail in each of them. What
  /// failed of earlier truth is done again by the new.
  std::string cell_command(const JobPlan& plan, const QueuedTasks& queued, const std::string& truth) const {
    std::vector<std::string> after;
    if (!truth.empty()) after.push_back("afterok:" + number_of(truth));
    for (const SubmittedJobs& each : queued.jobs)
      if (!each.truth.empty()) after.push_back("afterany:" + number_of(each.truth));
    if (after.empty()) return make_command(plan, {}, kCellScript);
    return make_command(plan, {fmt::format("--dependency={}", fmt::join(after, ",")), "--kill-on-invalid-dep=yes"},
                        kCellScript);
  }

  std::string merge_command(const JobPlan& plan, const QueuedTasks& queued, const std::string& cells) const {
    std::vector<std::string> after;
    if (!cells.empty()) after.push_back(number_of(cells));
    for (const SubmittedJobs& each : queued.jobs)
      if (!each.cells.empty()) after.push_back(number_of(each.cells));
    if (after.empty()) return make_command(plan, {}, kMergeScript);
    return make_command(plan, {fmt::format("--dependency=afterany:{}", fmt::join(after, ":"))}, kMergeScript);
  }

  std::vector<std::string> list_commands(const JobPlan& plan, const QueuedTasks& queued,
                                         const SubmittedJobs& names) const {
    std::vector<std::string> commands;
    if (!plan.truths.empty()) commands.push_back(truth_command(plan));
    if (!plan.tasks.empty()) commands.push_back(cell_command(plan, queued, plan.truths.empty() ? "" : names.truth));
    commands.push_back(merge_command(plan, queued, plan.tasks.empty() ? "" : names.cells));
    return commands;
  }

  /// Gives the job as sbatch names it: its number, perhaps with ';' and a cluster behind it.
  static std::string run_sbatch(const std::string& command) {
    const ShellOutcome outcome = run_shell(command);
    if (outcome.exit_code == kNoSuchCommand)
      throw Error(ErrorKind::kUsage,
                  "--engine slurm: there is no sbatch here; submit from a machine of the cluster, or choose --engine "
                  "parallel");
    std::string job;
    std::istringstream lines(outcome.text);
    for (std::string line; std::getline(lines, line);) {  // warnings may stand among them
      const std::string number = number_of(line);
      if (!number.empty() && std::ranges::all_of(number, [](char c) { return c >= '0' && c <= '9'; })) job = line;
    }
    if (outcome.exit_code != 0 || job.empty())
      throw Error(ErrorKind::kUsage, fmt::format("sbatch refuses: {}; nothing is submitted (of too many tasks, --tasks "
                                                 "asks for fewer)",
                                                 outcome.text));
    return job;
  }
};

}  // namespace

std::unique_ptr<Engine> make_slurm_engine(const EngineOptions& options, const fs::path& out) {
  if (out.string().find_first_of(kUnquotable) != std::string::npos)
    throw Error(ErrorKind::kUsage,
                "--out: Slurm cannot be told a folder with a double quote, a backslash or a line end in its name; "
                "choose another",
                out.string());
  return std::make_unique<SlurmEngine>(options);
}

}  // namespace shadowbench::submit
