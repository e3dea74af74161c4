#pragma once

#include <sys/types.h>

#include <chrono>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "harness/measure/scene_measurement.h"
#include "harness/options/options.h"
#include "harness/run/run_plan.h"

namespace shadowbench::run {

/// How a worker process ended.
struct WorkerOutcome {
  std::optional<int> exit_code = {};  ///< empty: killed by a signal or out of time
  bool timed_out = false;
  int signal = 0;               ///< that killed it; 0: none
  std::string error_text = {};  ///< what it wrote to standard error
};

/// What a worker process is.
struct WorkerSetup {
  std::filesystem::path program = "/proc/self/exe";  ///< this same program
  int niceness = 0;                                  ///< 0 .. 19
};

/// A process of a program with other arguments, in a process group of its own. It is killed with this object, and with
/// the thread that started it, however that ends; so are the workers of a worker. Its standard output is thrown away.
class WorkerProcess {
 public:
  /// Throws Error(kOutput) when no process can be started.
  explicit WorkerProcess(const std::vector<std::string>& arguments, const WorkerSetup& setup = {});
  ~WorkerProcess();
  WorkerProcess(const WorkerProcess&) = delete;
  WorkerProcess& operator=(const WorkerProcess&) = delete;

  /// Takes in what it writes to standard error until it ends, which is when this gives true, or until the deadline.
  bool listen(std::chrono::steady_clock::time_point deadline);

  /// What it has written so far.
  const std::string& error_text() const { return text_; }

  /// Kills it, unless it has ended, and tells how it ended.
  WorkerOutcome end();

 private:
  bool has_ended() const;

  pid_t process_ = -1;  ///< -1: none that could still be killed
  int pipe_ = -1;       ///< its standard error; -1: closed
  std::string text_;
};

/// The word that gives a worker the cache of the run that starts it; an empty path is none.
std::string cache_word(const std::filesystem::path& cache);

/// A worker's message without the program's name in front.
std::string clean_message(const std::string& text);

/// Runs this same program with other arguments, and kills it after `timeout_s` seconds.
/// Throws Error(kOutput) when no process can be started.
WorkerOutcome run_worker(const std::vector<std::string>& arguments, double timeout_s);

/// What a worker is told of its scene and its OpenGL.
struct WorkerScene {
  std::string argument;  ///< what the command line calls the scene
  std::string backend;
};

/// Measures a user's filter, beside `none`, in a process of its own, so that an endless loop or a driver that crashes
/// costs this cell and nothing else.
///
/// Returns the cell; its status says `timeout` or `crashed` where the process did not finish.
/// Throws FilterErrors for the filter's GLSL, with the worker's message, and Error for what else the worker refuses.
measure::MeasuredCell measure_user_filter(const options::RunOptions& options, const measure::SceneTask& task,
                                          const filters::FilterRequest& request, const WorkerScene& scene);

/// Compiles every user's filter that has a cell to be measured, once, each in a process of its own. A process that does
/// not finish is left to the cell to tell of.
/// Throws FilterErrors with the mistakes of all of them, and Error for what else a process refuses.
void check_user_filters(const RunPlan& plan, const std::string& backend);

}  // namespace shadowbench::run
