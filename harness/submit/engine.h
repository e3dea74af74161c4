#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "harness/submit/sweep_folder.h"

namespace shadowbench::submit {

/// What the user asks of an engine.
struct EngineOptions {
  std::string engine;
  std::string time, partition, gres;  ///< as sbatch takes them; empty: not asked for
  std::vector<std::string> words;     ///< further options of the engine's own program
};

/// The work that jobs are to do.
struct JobPlan {
  std::filesystem::path out;             ///< absolute: of the sweep
  std::filesystem::path working_folder;  ///< absolute: where paths of the command begin
  std::vector<std::string> program;      ///< words that start this program anywhere
  std::vector<std::string> command;      ///< words of a task, but for `--task FOLDER`
  std::string name;                      ///< of the jobs
  std::vector<int> truths, tasks;        ///< numbers of those that are to be done
};

/// Tasks that earlier jobs have before them or under way. A script has all tasks of its sweep for as long as it
/// runs.
struct QueuedTasks {
  std::set<int> truths, tasks;
  std::vector<SubmittedJobs> jobs;  ///< theirs; those that are done have no name here
};

/// Keeps the names of jobs as soon as there are any.
using NoteJobs = std::function<void(const SubmittedJobs&)>;

/// What distributes tasks over machines.
class Engine {
 public:
  virtual ~Engine() = default;

  virtual QueuedTasks find_queued(const std::filesystem::path& out, const std::vector<SubmittedJobs>& earlier) = 0;

  /// Writes scripts that a person can read into the folder of the sweep, and returns the commands that submit() gives
  /// them to. Throws Error(kOutput).
  virtual std::vector<std::string> write_scripts(const JobPlan& plan, const QueuedTasks& queued) = 0;

  /// Tells `note` of each job that it has made. Throws Error(kUsage) where the engine's program is missing or refuses;
  /// no job stays then, and `note` is told of jobs without names.
  virtual SubmittedJobs submit(const JobPlan& plan, const QueuedTasks& queued, const NoteJobs& note) = 0;
};

/// Names the engines.
std::vector<std::string> list_engines();

/// Of a sweep into `out`, which is absolute. Throws Error(kUsage) for an unknown name, for an option that the engine
/// does not have, and for a folder that it cannot be told.
std::unique_ptr<Engine> make_engine(const EngineOptions& options, const std::filesystem::path& out);

std::unique_ptr<Engine> make_slurm_engine(const EngineOptions& options, const std::filesystem::path& out);
std::unique_ptr<Engine> make_parallel_engine(const EngineOptions& options, const std::filesystem::path& out);

/// Writes words as a POSIX shell reads them: what is not plain stands in single quotes.
std::string quote_words(const std::vector<std::string>& words);

/// How a command of a shell ended.
struct ShellOutcome {
  int exit_code = 0;  ///< 127: there is no such command
  std::string text;   ///< what it wrote, to standard output and standard error, without the last newline
};

/// Runs a command in a shell, and waits for it. Throws Error(kOutput) where no process can be started.
ShellOutcome run_shell(const std::string& command);

}  // namespace shadowbench::submit
