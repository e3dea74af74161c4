#include <fmt/format.h>

#include <fstream>
#include <iterator>

#include "base/atomic_file.h"
#include "base/error.h"
#include "base/temporary_files.h"
#include "harness/submit/engine.h"
#include "harness/submit/sign_of_life.h"
#include "harness/submit/sweep_status.h"

namespace shadowbench::submit {
namespace {

namespace fs = std::filesystem;

constexpr const char *kScript = "submit.sh", *kLog = "submit.log";
/// Stands for the number of a task.
constexpr const char* kNumber = "@task@";

/// Whether a process "number@machine" still carries out the script of a sweep, which shows on other machines that it
/// does as tasks do.
bool carries_out(const std::string& process, const fs::path& out) {
  const std::size_t at = process.find('@');
  if (at != std::string::npos && process.substr(at + 1) != host_name()) {
    const auto sign = read_last_sign(out, file_system_now(out));
    return sign && sign->silent_s < kSilentAfter_s;
  }
  std::ifstream file("/proc/" + process.substr(0, at) + "/cmdline", std::ios::binary);
  const std::string words(std::istreambuf_iterator<char>(file), {});
  return words.find((out / kScript).string()) != std::string::npos;
}

class ParallelEngine : public Engine {
 public:
  explicit ParallelEngine(const EngineOptions& options) : options_(options) {
    for (const auto& [name, value] :
         {std::pair{"--time", options.time}, {"--partition", options.partition}, {"--gres", options.gres}})
      if (!value.empty())
        throw Error(ErrorKind::kUsage, fmt::format("{} is an option of --engine slurm; leave it out", name));
  }

  QueuedTasks find_queued(const fs::path& out, const std::vector<SubmittedJobs>& earlier) override {
    QueuedTasks queued;
    for (const SubmittedJobs& jobs : earlier) {
      if (jobs.engine != options_.engine || !carries_out(jobs.cells, out)) continue;
      const Sweep sweep = read_sweep(out);
      for (int i = 1; i <= sweep.truths; ++i) queued.truths.insert(i);
      for (int i = 1; i <= sweep.tasks; ++i) queued.tasks.insert(i);
      queued.jobs.push_back(jobs);
    }
    return queued;
  }

  std::vector<std::string> write_scripts(const JobPlan& plan, const QueuedTasks&) override {
    std::string script =
        "#!/bin/sh\n# Does the tasks of a sweep, and writes the report. Written by 'shadowbench submit'.\n"
        "# Stopped or started again, a task goes on where it was. One runs on a machine at a time: beside another, "
        "its times\n# would be of that too.\n\n" +
        show_life(quote_words({(plan.out / kSignOfLife).string()}));
    if (!plan.truths.empty())
      script += "\n" + describe_tasks(plan, TaskKind::kTruth, plan.truths) + " &\nwait $! || exit 1\n";
    if (!plan.tasks.empty()) script += "\n" + describe_tasks(plan, TaskKind::kCells, plan.tasks) + " &\nwait $!\n";
    std::vector<std::string> merge = plan.program;
    merge.insert(merge.end(), {"merge", plan.out.string()});
    write_text_file(plan.out / kScript, script + "\n" + quote_words(merge) + "\n");
    return {"setsid sh " + quote_words({(plan.out / kScript).string()})};
  }

  SubmittedJobs submit(const JobPlan& plan, const QueuedTasks& queued, const NoteJobs& note) override {
    const ShellOutcome found = run_shell("command -v setsid && parallel --version");
    if (found.exit_code != 0 || found.text.find("GNU parallel") == std::string::npos)
      throw Error(ErrorKind::kUsage, "--engine parallel: GNU parallel is not installed here, or not in PATH");
    const ShellOutcome outcome = run_shell(write_scripts(plan, queued).front() + " >> " +
                                           quote_words({(plan.out / kLog).string()}) + " 2>&1 < /dev/null & echo $!");
    const SubmittedJobs jobs{options_.engine, {}, outcome.text + "@" + host_name(), {}};
    note(jobs);
    return jobs;
  }

 private:
  EngineOptions options_;

  /// Touches a file every few seconds for as long as the script runs, and takes it away when it ends. Who ends the
  /// script ends all that it has started.
  static std::string show_life(const std::string& file) {
    return fmt::format(
        "trap 'rm -f \"$alive\"' EXIT\ntrap 'trap \"\" TERM; kill 0; exit 1' HUP INT TERM\nalive={}\n"
        "(while grep -qs . /proc/$$/cmdline; do touch \"$alive\"; sleep 5; done) > /dev/null 2>&1 &\n",
        file);
  }

  std::string describe_tasks(const JobPlan& plan, TaskKind kind, const std::vector<int>& numbers) const {
    const fs::path folder = task_folder(plan.out, kind, 1).parent_path() / kNumber;
    std::vector<std::string> command = plan.command;
    command.insert(command.end(), {"--task", folder.string()});
    const std::string line = fmt::format("cd {} && {} >> {} 2>&1", quote_words({plan.working_folder.string()}),
                                         quote_words(command), quote_words({(folder / "log.txt").string()}));
    std::vector<std::string> words = {"parallel", "--will-cite", "--jobs", "1"};
    words.insert(words.end(), options_.words.begin(), options_.words.end());
    words.insert(words.end(), {"-I", kNumber, line, ":::"});
    for (const int number : numbers) words.push_back(std::to_string(number));
    return quote_words(words);
  }
};

}  // namespace

std::unique_ptr<Engine> make_parallel_engine(const EngineOptions& options, const fs::path&) {
  return std::make_unique<ParallelEngine>(options);
}

}  // namespace shadowbench::submit
