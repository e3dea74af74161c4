#include "harness/cli/progress_bar.h"

#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>

namespace shadowbench::cli {
namespace {

constexpr int kBarCells = 24;

/// Estimates from the time of the finished cells how long the others will take.
class TimeLeft {
 public:
  void begin(int cells, int finished) {
    cells_ = cells;
    finished_ = finished;
    start_ = Clock::now();
  }

  /// " · 3 min left"; empty until a cell is finished, and at the end.
  std::string describe(int done) const {
    if (done <= finished_ || done >= cells_) return {};
    const double spent = std::chrono::duration<double>(Clock::now() - start_).count();
    const auto left = static_cast<long>(std::ceil(spent / (done - finished_) * (cells_ - done)));
    return left < 100 ? fmt::format(" · {} s left", left) : fmt::format(" · {} min left", (left + 59) / 60);
  }

 private:
  using Clock = std::chrono::steady_clock;
  int cells_ = 0;
  int finished_ = 0;
  Clock::time_point start_;
};

/// Cuts a text to so many bytes, between characters.
std::string cut(const std::string& text, std::size_t room) {
  if (text.size() <= room) return text;
  while (room > 0 && (static_cast<unsigned char>(text[room]) & 0xC0U) == 0x80U) --room;
  return text.substr(0, room);
}

/// Redraws one line.
class TerminalBar final : public options::Progress {
 public:
  ~TerminalBar() override { fmt::print(stderr, "\n"); }

  void begin(int cells, int finished) override {
    cells_ = std::max(cells, 1);
    left_.begin(cells, finished);
  }

  void show(int done, const std::string& what) override {
    const int filled = std::min(kBarCells, kBarCells * done / cells_);
    const std::string bar = std::string(static_cast<std::size_t>(filled), '#') +
                            std::string(static_cast<std::size_t>(kBarCells - filled), '.');
    fmt::print(stderr, "\r\033[K[{}] {}/{}{}", bar, done, cells_, cut(left_.describe(done) + " " + what, room()));
    std::fflush(stderr);
  }

  void note(const std::string& message) override { fmt::print(stderr, "\r\033[K{}\n", message); }

 private:
  int cells_ = 1;
  TimeLeft left_;

  /// Columns left beside the bar, so that the line never wraps.
  static std::size_t room() {
    winsize size{};
    const int columns = ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0 ? size.ws_col : 80;
    return static_cast<std::size_t>(std::max(columns - kBarCells - 14, 10));
  }
};

/// Prints one line for each step, for logs.
class PlainLines final : public options::Progress {
 public:
  void begin(int cells, int finished) override {
    cells_ = cells;
    left_.begin(cells, finished);
  }
  void show(int done, const std::string& what) override {
    fmt::print(stderr, "{}/{} {}{}\n", done, cells_, what, left_.describe(done));
  }
  void note(const std::string& message) override { fmt::print(stderr, "{}\n", message); }

 private:
  int cells_ = 0;
  TimeLeft left_;
};

}  // namespace

std::unique_ptr<options::Progress> make_progress() {
  if (isatty(STDERR_FILENO)) return std::make_unique<TerminalBar>();
  return std::make_unique<PlainLines>();
}

}  // namespace shadowbench::cli
