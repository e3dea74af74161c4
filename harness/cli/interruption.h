#pragma once

#include <filesystem>
#include <string>
#include <thread>

namespace shadowbench::cli {

/// The advice of commands that keep nothing of work that was interrupted.
constexpr const char* kStoppedAdvice = "nothing half-written is left; run the same command again";

/// While it lives, SIGINT, SIGTERM and SIGHUP remove what this process has half-written, say one last line and end the
/// program by that same signal. A signal that the program was started to ignore stays ignored. One at a time.
class Interruption {
 public:
  /// `advice` ends the line: what stays, and what to do.
  Interruption(std::filesystem::path out, std::string advice);
  ~Interruption();
  Interruption(const Interruption&) = delete;
  Interruption& operator=(const Interruption&) = delete;

 private:
  std::filesystem::path out_;
  std::string advice_;
  std::thread thread_;

  void wait() const;
  [[noreturn]] void end(int signal) const;
};

}  // namespace shadowbench::cli
