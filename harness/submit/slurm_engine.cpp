#include <fmt/format.h>
#include <fmt/ranges.h>

#include <sstream>

#include "filters/base/atomic_file.h"
#include "filters/base/error.h"
#include "harness/submit/engine.h"
#include "harness/submit/shell.h"

namespace shadowbench::submit {
namespace {

namespace fs = std::filesystem;

constexpr const char *kTruthScript = "truth.sbatch", *kCellScript = "submit.sbatch", *kMergeScript = "merge.sbatch";
constexpr int kNoSuchCommand = 127;

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
  explicit SlurmEngine(const EngineOptions& options) : options_(options) {}

  QueuedTasks find_queued(const fs::path&, const std::vector<SubmittedJobs>& earlier) override {
    QueuedTasks queued;
    for (const SubmittedJobs& jobs : earlier) {
      if (jobs.engine != options_.engine) continue;
      const std::size_t before = queued.truths.size() + queued.tasks.size();
      queued.truths.merge(list_array(jobs.truth));
      queued.tasks.merge(list_array(jobs.cells));
      if (queued.truths.size() + queued.tasks.size() > before) queued.jobs.push_back(jobs);
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

  SubmittedJobs submit(const JobPlan& plan, const QueuedTasks& queued) override {
    SubmittedJobs jobs{options_.engine, {}, {}, {}};
    try {
      if (!plan.truths.empty()) jobs.truth = run_sbatch(truth_command(plan));
      if (!plan.tasks.empty()) jobs.cells = run_sbatch(cell_command(plan, queued, jobs.truth));
      jobs.merge = run_sbatch(merge_command(plan, queued, jobs.cells));
    } catch (const Error&) {
      for (const std::string& job : {jobs.truth, jobs.cells})
        if (!job.empty()) run_shell(quote_words({"scancel", job}));
      throw;
    }
    for (const SubmittedJobs& each : queued.jobs) run_shell(quote_words({"scancel", each.merge}));  // it would be early
    return jobs;
  }

 private:
  EngineOptions options_;

  /// The numbers of an array's elements that are not done; none where Slurm has forgotten the job.
  static std::set<int> list_array(const std::string& job) {
    std::set<int> numbers;
    if (job.empty()) return numbers;
    const ShellOutcome outcome =
        run_shell(quote_words({"squeue", "--noheader", "--array", "--format=%K", "--jobs", job}));
    const bool is_forgotten = outcome.text.find("Invalid job id") != std::string::npos;
    if (is_forgotten || outcome.exit_code == kNoSuchCommand) return numbers;
    if (outcome.exit_code != 0)
      throw Error(ErrorKind::kUsage,
                  fmt::format("squeue refuses, so nobody can say which tasks wait: {}; try again once "
                              "Slurm answers",
                              outcome.text));
    std::istringstream lines(outcome.text);
    for (int number = 0; lines >> number;) numbers.insert(number);
    return numbers;
  }

  std::string describe_resources(bool whole_node) const {
    std::string lines;
    if (whole_node) lines += "#SBATCH --exclusive\n";  // beside other work, times would be of that work too
    if (whole_node && !options_.time.empty()) lines += "#SBATCH --time=" + options_.time + "\n";
    if (whole_node && !options_.gres.empty()) lines += "#SBATCH --gres=" + options_.gres + "\n";
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
                    what, plan.name, folder.filename().string(), describe_array(numbers),
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
                                plan.name, quote_pattern(plan.out / "merge.log"), describe_resources(false),
                                enter_folder(plan), quote_words(command)));
  }

  std::string make_command(const JobPlan& plan, const std::vector<std::string>& options, const char* script) const {
    std::vector<std::string> words = {"sbatch", "--parsable"};
    words.insert(words.end(), options.begin(), options.end());
    words.insert(words.end(), options_.words.begin(), options_.words.end());
    words.push_back((plan.out / script).string());
    return quote_words(words);
  }

  std::string truth_command(const JobPlan& plan) const { return make_command(plan, {}, kTruthScript); }

  /// Cells wait for all truth, and are not begun where that fails: what fails there would fail in each of them.
  std::string cell_command(const JobPlan& plan, const QueuedTasks& queued, const std::string& truth) const {
    std::vector<std::string> after;
    if (!truth.empty()) after.push_back(truth);
    for (const SubmittedJobs& each : queued.jobs)
      if (!each.truth.empty() && !queued.truths.empty()) after.push_back(each.truth);
    if (after.empty()) return make_command(plan, {}, kCellScript);
    return make_command(plan,
                        {fmt::format("--dependency=afterok:{}", fmt::join(after, ":")), "--kill-on-invalid-dep=yes"},
                        kCellScript);
  }

  std::string merge_command(const JobPlan& plan, const QueuedTasks& queued, const std::string& cells) const {
    std::vector<std::string> after;
    if (!cells.empty()) after.push_back(cells);
    for (const SubmittedJobs& each : queued.jobs)
      if (!each.cells.empty()) after.push_back(each.cells);
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

  /// Gives the job's number, which sbatch writes before a ';' and the cluster's name.
  static std::string run_sbatch(const std::string& command) {
    const ShellOutcome outcome = run_shell(command);
    if (outcome.exit_code == kNoSuchCommand)
      throw Error(ErrorKind::kUsage,
                  "--engine slurm: there is no sbatch here; submit from a machine of the cluster, or choose --engine "
                  "parallel");
    const std::string job = outcome.text.substr(outcome.text.find_last_of('\n') + 1);
    if (outcome.exit_code != 0 || job.empty())
      throw Error(ErrorKind::kUsage, fmt::format("sbatch refuses: {}; nothing is submitted", outcome.text));
    return job.substr(0, job.find(';'));
  }
};

}  // namespace

std::unique_ptr<Engine> make_slurm_engine(const EngineOptions& options) {
  return std::make_unique<SlurmEngine>(options);
}

}  // namespace shadowbench::submit
