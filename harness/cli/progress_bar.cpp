#include "harness/cli/progress_bar.h"

#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>

#include "harness/cli/print.h"

namespace shadowbench::cli {
namespace {

constexpr std::size_t kBarCells = 24;

/// " · 3 min left"
std::string describe_seconds(double seconds) {
  const auto left = static_cast<long>(std::ceil(seconds));
  return left < 100 ? fmt::format(" · {} s left", left) : fmt::format(" · {} min left", (left + 59) / 60);
}

/// Cuts a text to so many bytes, between characters.
std::string cut(const std::string& text, std::size_t room) {
  if (text.size() <= room) return text;
  while (room > 0 && (static_cast<unsigned char>(text[room]) & 0xC0U) == 0x80U) --room;
  return text.substr(0, room);
}

/// Where a run is, in words: "42.0 % · 16/40", or "16/40" where the work is counted, and the time left.
class Position {
 public:
  void begin(int cells, int finished) {
    cells_ = cells;
    finished_ = finished;
    start_ = Clock::now();
  }

  double share(int done, const std::optional<options::WorkAhead>& ahead) const {
    return ahead ? ahead->share : static_cast<double>(done) / std::max(cells_, 1);
  }

  /// Rounds down: what is not done is not 100 %.
  std::string count(int done, const std::optional<options::WorkAhead>& ahead) const {
    const std::string cells = fmt::format("{}/{}", done, cells_);
    return ahead ? fmt::format("{:.1f} % · {}", std::floor(1000.0 * ahead->share) / 10.0, cells) : cells;
  }

  /// " · 3 min left", from the time of the finished cells where the work is counted; empty until it can be told, and at
  /// the end.
  std::string describe_left(int done, const std::optional<options::WorkAhead>& ahead) const {
    if (ahead) return ahead->seconds_left && ahead->share < 1.0 ? describe_seconds(*ahead->seconds_left) : "";
    if (done <= finished_ || done >= cells_) return {};
    const double spent = std::chrono::duration<double>(Clock::now() - start_).count();
    return describe_seconds(spent / (done - finished_) * (cells_ - done));
  }

 private:
  using Clock = std::chrono::steady_clock;
  int cells_ = 0;
  int finished_ = 0;
  Clock::time_point start_;
};

/// Redraws one line.
class TerminalBar final : public options::Progress {
 public:
  ~TerminalBar() override { fmt::print(stderr, "\n"); }

  void begin(int cells, int finished) override { position_.begin(cells, finished); }

  void show(int done, const std::string& what, const std::optional<options::WorkAhead>& ahead) override {
    const double share = std::clamp(position_.share(done, ahead), 0.0, 1.0);
    const auto filled = static_cast<std::size_t>(static_cast<double>(kBarCells) * share);
    const std::string bar = std::string(filled, '#') + std::string(kBarCells - filled, '.');
    const std::string head = position_.count(done, ahead);
    fmt::print(stderr, "\r\033[K[{}] {}{}", bar, head,
               cut(make_visible(position_.describe_left(done, ahead) + " " + what), room(head)));
    std::fflush(stderr);
  }

  void note(const std::string& message) override { fmt::print(stderr, "\r\033[K{}\n", make_readable(message)); }

 private:
  Position position_;

  /// Columns left beside the bar, so that the line never wraps.
  static std::size_t room(const std::string& head) {
    winsize size{};
    const int columns = ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0 ? size.ws_col : 80;
    return static_cast<std::size_t>(std::max(columns - static_cast<int>(kBarCells + head.size()) - 5, 10));
  }
};

/// Prints what is worth a line of a log: every note, and how far the work is at each fifth of it.
class LogLines final : public options::Progress {
 public:
  void begin(int cells, int finished) override {
    position_.begin(cells, finished);
    fifths_ = 0;
  }

  void show(int done, const std::string& what, const std::optional<options::WorkAhead>& ahead) override {
    const double share = position_.share(done, ahead);
    const int fifths = static_cast<int>(std::floor(5.0 * share));
    if (fifths <= fifths_) return;
    fifths_ = fifths;
    if (share < 1.0 && lines_ >= kMostLines - kLastLines) return;
    note(fmt::format("{} {}{}", position_.count(done, ahead), what, position_.describe_left(done, ahead)));
  }

  void note(const std::string& message) override {
    ++lines_;
    print_message("{}\n", message);
  }

 private:
  static constexpr int kMostLines = 10;  ///< of a run; progress is left out where notes are many
  static constexpr int kLastLines = 2;   ///< "done", and where the report is
  Position position_;
  int fifths_ = 0;  ///< of the work, that were told
  int lines_ = 0;
};

/// Prints one line for each step, for the window and for tests, and one now and then while a step goes on.
class StepLines final : public options::Progress {
 public:
  void begin(int cells, int finished) override { position_.begin(cells, finished); }

  void show(int done, const std::string& what, const std::optional<options::WorkAhead>& ahead) override {
    const auto now = std::chrono::steady_clock::now();
    if (ahead && what == what_ && now - shown_ < kPause) return;
    what_ = what;
    shown_ = now;
    print_message("{} {}{}\n", position_.count(done, ahead), what, position_.describe_left(done, ahead));
  }

  void note(const std::string& message) override { print_message("{}\n", message); }

 private:
  static constexpr std::chrono::seconds kPause{2};
  Position position_;
  std::string what_;
  std::chrono::steady_clock::time_point shown_;
};

}  // namespace

std::unique_ptr<options::Progress> make_progress(bool every_step) {
  if (isatty(STDERR_FILENO)) return std::make_unique<TerminalBar>();
  if (every_step) return std::make_unique<StepLines>();
  return std::make_unique<LogLines>();
}

}  // namespace shadowbench::cli
