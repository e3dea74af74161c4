#pragma once

#include <fmt/format.h>

#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <thread>
#include <utility>

#include "base/text.h"
#include "harness/options/options.h"

namespace shadowbench::cli {

/// Prints text for people on standard output, with names as make_visible() shows them. JSON is printed as it is.
template <class... Values>
void print(fmt::format_string<Values...> format, Values&&... values) {
  fmt::print("{}", make_visible(fmt::format(format, std::forward<Values>(values)...)));
}

/// Prints a message for people on standard error.
template <class... Values>
void print_message(fmt::format_string<Values...> format, Values&&... values) {
  fmt::print(stderr, "{}", make_readable(fmt::format(format, std::forward<Values>(values)...)));
}

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

/// Shows progress on standard error: one line that is redrawn on a terminal; elsewhere a line for each fifth of the
/// work, or for every step.
std::unique_ptr<options::Progress> make_progress(bool every_step = false);

/// Does work that writes to the folder `out`: shows its progress, and removes what is half-written where a signal ends
/// it. Returns what the work returns.
template <class Work>
auto work_with_progress(const std::filesystem::path& out, const Work& work, const std::string& advice = kStoppedAdvice,
                        bool every_step = false) {
  const Interruption interruption(out, advice);
  const std::unique_ptr<options::Progress> progress = make_progress(every_step);
  return work(*progress);
}

}  // namespace shadowbench::cli
