#include "harness/cli/interruption.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdio>
#include <system_error>
#include <utility>

#include "base/files.h"

namespace shadowbench::cli {
namespace {

constexpr int kSignals[] = {SIGINT, SIGTERM, SIGHUP};
constexpr unsigned char kNone = 0;

int g_pipe[2] = {-1, -1};  // a signal handler can reach nothing that is not global

extern "C" void send_signal(int signal) {
  const int before = errno;
  const auto byte = static_cast<unsigned char>(signal);
  [[maybe_unused]] const ssize_t sent = write(g_pipe[1], &byte, 1);
  errno = before;
}

void set_handler(int signal, void (*handler)(int)) {
  struct sigaction old {
  }, action{};
  sigaction(signal, nullptr, &old);
  if (old.sa_handler == SIG_IGN) return;
  action.sa_handler = handler;
  action.sa_flags = SA_RESTART;
  sigemptyset(&action.sa_mask);
  sigaction(signal, &action, nullptr);
}

const char* name_of(int signal) { return signal == SIGINT ? "SIGINT" : signal == SIGTERM ? "SIGTERM" : "SIGHUP"; }

}  // namespace

Interruption::Interruption(std::filesystem::path out, std::string advice)
    : out_(std::move(out)), advice_(std::move(advice)) {
  if (pipe2(g_pipe, O_CLOEXEC) != 0) return;  // without a pipe, a signal ends the program at once, as it ends others
  try {
    thread_ = std::thread([this] { wait(); });
  } catch (const std::system_error&) {
    for (int& end : g_pipe) close(std::exchange(end, -1));
    return;
  }
  for (const int signal : kSignals) set_handler(signal, send_signal);
}

Interruption::~Interruption() {
  if (!thread_.joinable()) return;
  for (const int signal : kSignals) set_handler(signal, SIG_DFL);
  send_signal(kNone);
  // Where a signal came first, the thread ends the program, and nothing is said after its line.
  thread_.join();
  for (int& end : g_pipe) close(std::exchange(end, -1));
}

void Interruption::wait() const {
  unsigned char byte = kNone;
  while (read(g_pipe[0], &byte, 1) < 0 && errno == EINTR) {
  }
  if (byte != kNone) end(byte);
}

void Interruption::end(int signal) const {
  remove_temporary_files(out_, [](const Writer& writer) { return writer == this_writer(); });
  flockfile(stderr);  // and never given back: what other threads are about to say must not follow this line
  fmt::print(stderr, "{}shadowbench: stopped by {}; {}\n", isatty(STDERR_FILENO) ? "\n" : "", name_of(signal), advice_);
  std::fflush(stderr);
  std::signal(signal, SIG_DFL);
  kill(getpid(), signal);
  for (;;) pause();
}

}  // namespace shadowbench::cli
