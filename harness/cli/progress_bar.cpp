#include "harness/cli/progress_bar.h"

#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>

namespace shadowbench::cli {
namespace {

constexpr int kBarCells = 24;

/// Redraws one line.
class TerminalBar final : public run::Progress {
 public:
  ~TerminalBar() override { fmt::print(stderr, "\n"); }

  void begin(int cells) override { cells_ = std::max(cells, 1); }

  void show(int done, const std::string& what) override {
    const int filled = std::min(kBarCells, kBarCells * done / cells_);
    const std::string bar = std::string(static_cast<std::size_t>(filled), '#') +
                            std::string(static_cast<std::size_t>(kBarCells - filled), '.');
    fmt::print(stderr, "\r\033[K[{}] {}/{} {}", bar, done, cells_, what.substr(0, room()));
    std::fflush(stderr);
  }

  void note(const std::string& message) override { fmt::print(stderr, "\r\033[K{}\n", message); }

 private:
  int cells_ = 1;

  /// Columns left beside the bar, so that the line never wraps.
  static std::size_t room() {
    winsize size{};
    const int columns = ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0 ? size.ws_col : 80;
    return static_cast<std::size_t>(std::max(columns - kBarCells - 14, 10));
  }
};

/// Prints a line per step, for logs.
class PlainLines final : public run::Progress {
 public:
  void begin(int cells) override { cells_ = cells; }
  void show(int done, const std::string& what) override { fmt::print(stderr, "{}/{} {}\n", done, cells_, what); }
  void note(const std::string& message) override { fmt::print(stderr, "{}\n", message); }

 private:
  int cells_ = 0;
};

}  // namespace

std::unique_ptr<run::Progress> make_progress() {
  if (isatty(STDERR_FILENO)) return std::make_unique<TerminalBar>();
  return std::make_unique<PlainLines>();
}

}  // namespace shadowbench::cli
