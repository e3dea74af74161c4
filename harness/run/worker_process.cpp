#include "harness/run/worker_process.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstring>

#include "filters/base/error.h"

extern char** environ;

namespace shadowbench::run {
namespace {

using Clock = std::chrono::steady_clock;

pid_t spawn_self(const std::vector<std::string>& arguments, int error_write_end) {
  std::vector<std::string> words = {"shadowbench"};
  words.insert(words.end(), arguments.begin(), arguments.end());
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);

  posix_spawn_file_actions_t files;
  posix_spawn_file_actions_init(&files);
  posix_spawn_file_actions_addopen(&files, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
  posix_spawn_file_actions_adddup2(&files, error_write_end, STDERR_FILENO);
  posix_spawnattr_t attributes;
  posix_spawnattr_init(&attributes);
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP);
  posix_spawnattr_setpgroup(&attributes, 0);
  pid_t pid = -1;
  const int error = posix_spawn(&pid, "/proc/self/exe", &files, &attributes, argv.data(), environ);
  posix_spawn_file_actions_destroy(&files);
  posix_spawnattr_destroy(&attributes);
  if (error != 0) throw Error(ErrorKind::kOutput, fmt::format("cannot start a process: {}", std::strerror(error)));
  return pid;
}

/// What a worker wrote.
struct WorkerText {
  std::string text;
  bool complete = false;  ///< false: the deadline passed before the worker closed the pipe
};

WorkerText read_until(int fd, Clock::time_point deadline) {
  WorkerText result;
  std::array<char, 4096> buffer;
  while (!result.complete) {
    const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(deadline - Clock::now()).count();
    if (left <= 0) return result;
    pollfd waiting{fd, POLLIN, 0};
    if (poll(&waiting, 1, static_cast<int>(left)) <= 0) continue;
    const ssize_t got = read(fd, buffer.data(), buffer.size());
    if (got > 0) result.text.append(buffer.data(), static_cast<std::size_t>(got));
    result.complete = got == 0 || (got < 0 && errno != EINTR);
  }
  return result;
}

}  // namespace

std::string clean_message(const std::string& text) {
  const std::string prefix = "shadowbench: ";
  const std::size_t begin = text.find(prefix);
  std::string message = begin == std::string::npos ? text : text.substr(begin + prefix.size());
  while (!message.empty() && message.back() == '\n') message.pop_back();
  return message.empty() ? "no message" : message;
}

WorkerOutcome run_worker(const std::vector<std::string>& arguments, double timeout_s) {
  int ends[2];
  if (pipe2(ends, O_CLOEXEC) != 0)
    throw Error(ErrorKind::kOutput, fmt::format("cannot make a pipe for a process: {}", std::strerror(errno)));
  const auto deadline = Clock::now() + std::chrono::milliseconds(static_cast<std::int64_t>(timeout_s * 1000.0));
  const pid_t pid = spawn_self(arguments, ends[1]);
  close(ends[1]);
  const WorkerText written = read_until(ends[0], deadline);
  WorkerOutcome outcome{.timed_out = !written.complete, .error_text = written.text};
  close(ends[0]);
  if (outcome.timed_out) kill(-pid, SIGKILL);
  int status = 0;
  while (waitpid(pid, &status, 0) < 0 && errno == EINTR) {
  }
  if (WIFSIGNALED(status)) outcome.signal = WTERMSIG(status);
  if (WIFEXITED(status) && !outcome.timed_out) outcome.exit_code = WEXITSTATUS(status);
  return outcome;
}

}  // namespace shadowbench::run
