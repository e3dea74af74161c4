#pragma once

#include <chrono>
#include <condition_variable>
#include <filesystem>
#include <mutex>
#include <optional>
#include <thread>

namespace shadowbench::submit {

/// The name of the file that shows it.
inline constexpr const char* kSignOfLife = "alive";

/// How often a task shows that it runs.
inline constexpr std::chrono::milliseconds kBeat{5000};

/// Shows that a task runs, by a file in its folder that is touched every few seconds for as long as this object lives.
/// The time of the file is set by the file system, so that no two clocks are compared.
class SignOfLife {
 public:
  /// Throws Error(kOutput) where the file cannot be written.
  explicit SignOfLife(std::filesystem::path folder, std::chrono::milliseconds beat = kBeat);
  ~SignOfLife();
  SignOfLife(const SignOfLife&) = delete;
  SignOfLife& operator=(const SignOfLife&) = delete;

 private:
  std::filesystem::path file_;
  std::chrono::milliseconds beat_;
  std::mutex mutex_;
  std::condition_variable wake_;
  bool ending_ = false;
  std::thread thread_;

  void keep_beating();
};

/// Takes the sign of life away, for a task that a signal ends.
void remove_sign_of_life(const std::filesystem::path& folder);

/// What a task last showed.
struct LastSign {
  double silent_s = 0.0;  ///< seconds since then
  bool is_gone = false;   ///< it ran on this machine, and its process has ended
};

/// Nothing where a task does not run, or has not begun. `now` is file_system_now() of the folder of the sweep.
std::optional<LastSign> read_last_sign(const std::filesystem::path& folder, std::filesystem::file_time_type now);

/// The time of the file system of a folder, which need not be that of this machine: a file is written there, and
/// removed. Where none can be written it is the time of this machine.
std::filesystem::file_time_type file_system_now(const std::filesystem::path& folder);

}  // namespace shadowbench::submit
