#include "report/page/gnuplot.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstring>
#include <thread>

extern char** environ;

namespace shadowbench::page {
namespace {

using Clock = std::chrono::steady_clock;

constexpr fmt::string_view kMissing =
    "gnuplot cannot be started ({}); install gnuplot-nox and run again for static plots";

// Runs a program in a folder, in silence. Returns 0 with `pid` set, or the error.
struct Started {
  int error = 0;
  pid_t pid = -1;
};

Started start_gnuplot(const std::filesystem::path& dir, const std::filesystem::path& script) {
  std::string folder = dir.string(), file = script.string();
  std::string program = "gnuplot", defaults = "-d";
  char* const argv[] = {program.data(), defaults.data(), file.data(), nullptr};
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addchdir_np(&actions, folder.c_str());
  posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
  posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, "/dev/null", O_WRONLY, 0);
  Started started;
  started.error = posix_spawnp(&started.pid, program.c_str(), &actions, nullptr, argv, environ);
  posix_spawn_file_actions_destroy(&actions);
  return started;
}

// Returns the status, or nothing where the time ran out; the process is gone then too.
std::optional<int> wait_for(pid_t pid, double timeout_s) {
  const auto deadline = Clock::now() + std::chrono::milliseconds(static_cast<long>(timeout_s * 1000.0));
  int status = 0;
  for (;;) {
    const pid_t ended = waitpid(pid, &status, WNOHANG);
    if (ended == pid) return status;
    if (ended < 0 && errno != EINTR) return std::nullopt;
    if (Clock::now() >= deadline) break;
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  kill(pid, SIGKILL);
  while (waitpid(pid, &status, 0) < 0 && errno == EINTR) {
  }
  return std::nullopt;
}

}  // namespace

std::optional<std::string> run_gnuplot(const std::filesystem::path& dir, const std::filesystem::path& script,
                                       double timeout_s) {
  const Started started = start_gnuplot(dir, script);
  if (started.error != 0) return fmt::format(fmt::runtime(kMissing), std::strerror(started.error));
  const auto status = wait_for(started.pid, timeout_s);
  if (!status) return fmt::format("gnuplot took longer than {} s and was stopped", timeout_s);
  if (WIFEXITED(*status) && WEXITSTATUS(*status) == 0) return std::nullopt;
  // An older C library reports a missing program by this exit code.
  if (WIFEXITED(*status) && WEXITSTATUS(*status) == 127) return fmt::format(fmt::runtime(kMissing), "not found");
  return fmt::format("gnuplot failed; 'gnuplot {}' in the report folder says why", script.string());
}

}  // namespace shadowbench::page
