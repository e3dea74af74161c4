#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <optional>

namespace shadowbench::options {

/// Kinds of work of a run; all of one kind is taken to cost alike.
enum class Work {
  kDrawing,
  kTiming,
  kPhases,
  kTruth,
  kScores,
  kSurroundings,
  kAttribution,
  kGpus,
  kFrames,
  kPictures,
  kReport,
};
inline constexpr std::size_t kWorks = static_cast<std::size_t>(Work::kReport) + 1;

/// What is known of the work that lies ahead.
struct WorkAhead {
  double share = 0.0;                  ///< of the cost of all work, that is behind; never falls
  std::optional<double> seconds_left;  ///< nothing until enough is done to tell
};

/// Weighs how much of a plan is done. Every piece of work is planned with its presumed cost, in any unit; how a kind's
/// costs compare with those of the others is learned from the time that its pieces take. Where the plan is found to be
/// wrong the share moves faster or slower from there on, and never back.
class WorkMeter {
 public:
  /// `clock` gives seconds.
  explicit WorkMeter(std::function<double()> clock);

  /// Presumes work that is to be done.
  void plan(Work kind, double cost);

  /// Takes time from now on as that of this piece of work; the one before it is done.
  void begin(Work kind, double cost);

  /// So much of the piece under way is done, 0 .. 1; less than was said before is ignored.
  void advance(double part);

  /// All work is done, also what was planned and is not needed.
  void finish();

  WorkAhead ahead() const;

 private:
  struct Kind {
    double left = 0.0;  ///< presumed cost
    double done = 0.0;
    double seconds = 0.0;  ///< that what is done took
  };

  std::function<double()> clock_;
  std::array<Kind, kWorks> kinds_{};
  std::size_t current_ = 0;
  double cost_ = 0.0;  ///< of the piece under way
  double part_ = 1.0;  ///< of it that is done
  double last_s_;
  double share_ = 0.0;

  double rate(const Kind& kind) const;
  double seconds_left() const;
};

}  // namespace shadowbench::options
