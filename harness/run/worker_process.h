#pragma once

#include <optional>
#include <string>
#include <vector>

namespace shadowbench::run {

/// How a worker process ended.
struct WorkerOutcome {
  std::optional<int> exit_code = {};  ///< empty: killed by a signal or out of time
  bool timed_out = false;
  int signal = 0;               ///< that killed it; 0: none
  std::string error_text = {};  ///< what it wrote to standard error
};

/// A worker's message without the program's name in front.
std::string clean_message(const std::string& text);

/// Runs this same program with other arguments in a process group of its own, and kills it after `timeout_s` seconds.
/// Its standard output is thrown away.
/// Throws Error(kOutput) when no process can be started.
WorkerOutcome run_worker(const std::vector<std::string>& arguments, double timeout_s);

}  // namespace shadowbench::run
