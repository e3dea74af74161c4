#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "harness/view/workbench.h"

namespace shadowbench::view {

/// Keeps the root mean square error of both sides to the truth, over the pixels that are drawn.
class ErrorMeter {
 public:
  explicit ErrorMeter(Workbench& bench) : bench_(bench) {}

  /// Measures what was drawn, once nothing has changed for a moment and the truth is there; to be called once a frame,
  /// after the drawing. Cost: then the lookup of both sides in all columns, and tens of milliseconds a megapixel.
  void step(double now_s);

  /// Nothing for the truth, and where there is no error yet.
  std::optional<double> rmse(std::size_t side) const { return rmse_[side]; }

  /// The same in words: "RMSE 0.0312", or why there is none; empty for the truth.
  std::string describe(std::size_t side) const;

 private:
  Workbench& bench_;
  std::uint64_t drawing_ = 0;
  double since_s_ = 0.0;  ///< when that drawing was first seen
  bool is_measured_ = false;
  std::array<std::optional<double>, kSides> rmse_;
};

/// Times of one kind since the last drawing, milliseconds, the oldest first.
using TimeHistory = std::vector<float>;

/// Times the passes of what is shown as a run does: one by one, each closed, a lookup four lookups after its prefilter.
/// It runs one pass a frame, and only while nothing moves and nothing else works: such times compare.
class TimeMeter {
 public:
  struct Side {
    TimeHistory prefilter;
    TimeHistory lookup;
    TimeHistory filter;  ///< the lookup less an empty one, of one round
  };

  explicit TimeMeter(Workbench& bench) : bench_(bench) {}

  /// Runs the next pass, unless enough rounds have been timed since the last drawing. Whether more passes wait.
  bool step();

  const TimeHistory& map() const { return map_; }
  const Side& side(std::size_t side) const { return sides_[side]; }

 private:
  Workbench& bench_;
  TimeHistory map_;
  std::array<Side, kSides> sides_;
  std::vector<std::function<void()>> round_;  ///< passes of the round that are still to be run, the last one first
  std::uint64_t drawing_ = 0;
  std::size_t rounds_ = 0;
  float lookup_ms_ = 0.0f;

  void plan_round();
  void plan_side(std::size_t side, std::vector<std::function<void()>>& round);
  float time(const std::function<void()>& work) const;
};

/// Lays out the times of both sides, with their history, in the current ImGui window.
void show_times(const Workbench& bench, const TimeMeter& meter);

}  // namespace shadowbench::view
