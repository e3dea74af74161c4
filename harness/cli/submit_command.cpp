#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <memory>

#include "harness/cli/commands.h"
#include "harness/cli/print.h"
#include "harness/cli/progress_bar.h"
#include "harness/cli/run_arguments.h"
#include "harness/submit/submit_sweep.h"

namespace shadowbench::cli {
namespace {

namespace fs = std::filesystem;

struct SubmitArguments : RunArguments {
  submit::EngineOptions engine;
  std::string tasks;
  bool dry_run = false;
};

/// The options that a run does not have.
void add_engine_options(Command& command, SubmitArguments& a) {
  command.add("--engine", &a.engine.engine, "what distributes the tasks: 'slurm', or 'parallel', which is GNU parallel")
      .one_of(submit::list_engines())
      .require();
  command.add("--tasks", &a.tasks,
              "into how many tasks to split (default: twice the square root of the number of cells, at most 1000)");
  command.add("--time", &a.engine.time, "time limit of a task, as sbatch takes it");
  command.add("--partition", &a.engine.partition, "partition of the jobs, as sbatch takes it");
  command.add("--gres", &a.engine.gres, "what a node must have, as sbatch takes it, such as gpu:1");
  command.add("--dry-run", &a.dry_run, "write the scripts and print the commands; submit nothing");
}

/// Options of a run that make no sense of a sweep, whose tasks go on where they were.
constexpr const char* kNotOfSweeps[] = {"--shard", "--fresh",          "--yes", "--strict", "--worker",
                                        "--task",  "--until-different"};
/// Options that every task is given anew.
constexpr const char* kOfEveryTask[] = {"--out", "--cache", "--no-cache", "--grids", "--no-grids"};

/// The words of a `submit` that say what is measured.
std::vector<std::string> list_task_words(const std::vector<std::string>& words) {
  SubmitArguments ignored;
  Command own;
  add_engine_options(own, ignored);
  own.add("--out", &ignored.out, "");
  own.add("--cache", &ignored.cache, "");
  std::vector<std::string> kept;
  for (std::size_t i = 2; i < words.size() && words[i] != "--"; ++i) {
    const std::string name = words[i].substr(0, words[i].find('='));
    const auto option = std::ranges::find(own.options, name, &Option::name);
    if (option != own.options.end() && !option->is_flag() && name == words[i]) ++i;  // its value
    const bool is_own = option != own.options.end() || std::ranges::count(kOfEveryTask, name) > 0;
    if (!is_own) kept.push_back(words[i]);
  }
  return kept;
}

/// What starts this program anywhere.
std::vector<std::string> list_program_words() {
  std::vector<std::string> words;
  if (const char* root = std::getenv("SHADOWBENCH_ROOT"))
    words = {"env", "SHADOWBENCH_ROOT=" + fs::absolute(root).string()};
  words.push_back(fs::read_symlink("/proc/self/exe").string());
  return words;
}

submit::JobPlan make_job_plan(const options::RunOptions& options, const SubmitArguments& a,
                              const std::vector<std::string>& words) {
  submit::JobPlan plan{.out = options.out,
                       .working_folder = fs::current_path(),
                       .program = list_program_words(),
                       .command = {},
                       .name = fs::path(a.experiment).stem().string(),
                       .truths = {},
                       .tasks = {}};
  plan.command = plan.program;
  plan.command.push_back("run");
  const std::vector<std::string> own = list_task_words(words);
  plan.command.insert(plan.command.end(), own.begin(), own.end());
  plan.command.insert(plan.command.end(), {"--no-grids", "--out", options.out.string()});
  if (options.cache.empty())
    plan.command.push_back("--no-cache");
  else
    plan.command.insert(plan.command.end(), {"--cache", options.cache.string()});
  return plan;
}

int submit(const CommandLine& line, SubmitArguments& a) {
  if (a.grids() > 0) fail("--grids shows all filters of a view, and a task has some of them; leave it out");
  const std::string title = apply_experiment(line, a);
  if (!a.engines.empty())
    fail(
        "the experiment's [[engine]] tables are for 'run': leave them out, and score the finished sweep's renderers "
        "there");
  a.grids() = -1;  // whatever the experiment says
  if (a.out.empty()) fail("--out: name a folder that all machines share");
  a.out = fs::absolute(a.out).lexically_normal().string();
  a.cache = a.cache.empty() ? (fs::path(a.out) / "cache").string() : fs::absolute(a.cache).lexically_normal().string();
  options::RunOptions options = make_run_options(a, line.words());
  options.title = title;
  const std::unique_ptr<options::Progress> progress = make_progress();
  for (const std::string& note : options.notes) progress->note("note: " + note);
  const submit::SubmitRequest request{.engine = a.engine,
                                      .tasks = a.tasks.empty() ? 0 : parse_count(a.tasks, "--tasks"),
                                      .jobs = make_job_plan(options, a, line.words()),
                                      .dry_run = a.dry_run};
  const Interruption interruption(options.out, "the same command goes on");
  for (const std::string& each : submit::submit_sweep(options, request, *progress)) print("{}\n", each);
  print("'shadowbench status {}' says how far it is\n", a.out);
  return 0;
}

}  // namespace

Command make_submit_command() {
  Command command{"submit", "Measure an experiment on many machines: on Slurm, or with GNU parallel"};
  command.about =
      "Splits the experiment into tasks of equally many cells, writes scripts that one can read into the folder, and "
      "submits them: truth is traced first, once, then the tasks measure their cells, then the report is written. "
      "'shadowbench status' says how far it is. The same command again submits what is left.\n"
      "Words after -- go to sbatch, or to parallel, as they are.\n"
      "The folder, the program and all files that are named must be the same on all machines.";
  auto a = std::make_shared<SubmitArguments>();
  add_run_options(command, *a);
  a->out.clear();
  std::erase_if(command.options,
                [](const Option& option) { return std::ranges::count(kNotOfSweeps, option.name) > 0; });
  for (Option& option : command.options) {
    if (option.name == "--grids") option.hidden = true;
    if (option.name == "--out") option.required = true;
    if (option.name == "--out") option.help = "folder of the sweep and of its report, which all machines share";
    if (option.name == "--cache")
      option.help = "folder for traced images, which all machines share (default: cache in --out)";
  }
  add_engine_options(command, *a);
  command.rest = &a->engine.words;
  command.action = [a](const CommandLine& line) { return submit(line, *a); };
  return command;
}

}  // namespace shadowbench::cli
