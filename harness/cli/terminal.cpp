#include "harness/cli/terminal.h"

#include <fcntl.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <csignal>
#include <system_error>

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

constexpr std::size_t kBarCells = 24;

std::string describe_seconds(double seconds) {
  const auto whole = static_cast<long>(std::ceil(seconds));
  return whole < 100 ? fmt::format("{} s", whole) : fmt::format("{} min", (whole + 59) / 60);
}

/// Cuts a text to so many bytes, between characters.
std::string cut(const std::string& text, std::size_t room) {
  if (text.size() <= room) return text;
  while (room > 0 && (static_cast<unsigned char>(text[room]) & 0xC0U) == 0x80U) --room;
  return text.substr(0, room);
}

/// Where a run is.
class Position {
 public:
  void begin(int cells, int finished) {
    cells_ = cells;
    finished_ = done_ = finished;
    start_ = last_ = Clock::now();
  }

  double share() const { return static_cast<double>(done_) / std::max(cells_, 1); }

  /// "16/40 · 35 s, 50 s left": the time since the beginning, and the rest, if cells go on to take as long as those
  /// that are finished.
  std::string move(int done) {
    const auto now = Clock::now();
    const auto since = [&](Clock::time_point then) { return std::chrono::duration<double>(now - then).count(); };
    if (std::exchange(done_, done) != done) last_ = now;
    std::string text = fmt::format("{}/{} · {}", done_, cells_, describe_seconds(since(start_)));
    if (done_ <= finished_ || done_ >= cells_) return text;
    const double cell_s = (since(start_) - since(last_)) / (done_ - finished_);
    const double left_s = cell_s * (cells_ - done_) - since(last_);
    return left_s < 1.0 ? text : text + fmt::format(", {} left", describe_seconds(left_s));
  }

 private:
  using Clock = std::chrono::steady_clock;
  int cells_ = 0;
  int finished_ = 0;  ///< before the beginning
  int done_ = 0;
  Clock::time_point start_, last_;  ///< when the newest cell was finished
};

/// Shows progress as a line that is redrawn, as what is worth a line of a log, or as a line for each step, for the
/// window and for tests.
class Display final : public options::Progress {
 public:
  enum class Style { kBar, kLog, kSteps };
  explicit Display(Style style) : style_(style) {}
  ~Display() override {
    if (style_ == Style::kBar) fmt::print(stderr, "\n");
  }

  void begin(int cells, int finished) override {
    position_.begin(cells, finished);
    fifths_ = 0;
  }

  void show(int done, const std::string& what) override {
    const std::string head = position_.move(done);
    if (style_ == Style::kBar) return draw_bar(head, what);
    if (style_ == Style::kLog && !is_worth_a_line()) return;
    note(head + " · " + what);
  }

  void note(const std::string& message) override {
    ++lines_;
    if (style_ == Style::kBar) fmt::print(stderr, "\r\033[K");
    print_message("{}\n", message);
  }

 private:
  static constexpr int kMostLines = 10;  ///< of a run's log; progress is left out where notes are many
  static constexpr int kLastLines = 3;   ///< that the report is written, "done", and where it is
  Style style_;
  Position position_;
  int fifths_ = 0;  ///< of the work, that were told
  int lines_ = 0;

  /// Whether another fifth of the work is done.
  bool is_worth_a_line() {
    const int fifths = static_cast<int>(std::floor(5.0 * position_.share()));
    if (fifths <= fifths_ && fifths < 5) return false;
    fifths_ = fifths;
    return fifths == 5 || lines_ < kMostLines - kLastLines;
  }

  /// The text is cut so that the line never wraps.
  void draw_bar(const std::string& head, const std::string& what) const {
    winsize size{};
    const int columns = ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0 ? size.ws_col : 80;
    const auto room = static_cast<std::size_t>(std::max(columns - static_cast<int>(kBarCells + head.size()) - 8, 10));
    const auto filled = static_cast<std::size_t>(static_cast<double>(kBarCells) * std::min(position_.share(), 1.0));
    const std::string bar = std::string(filled, '#') + std::string(kBarCells - filled, '.');
    fmt::print(stderr, "\r\033[K[{}] {} · {}", bar, head, cut(make_visible(what), room));
    std::fflush(stderr);
  }
};

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

std::unique_ptr<options::Progress> make_progress(bool every_step) {
  using Style = Display::Style;
  return std::make_unique<Display>(isatty(STDERR_FILENO) ? Style::kBar : every_step ? Style::kSteps : Style::kLog);
}

}  // namespace shadowbench::cli
