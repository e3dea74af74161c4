#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>

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

}  // namespace shadowbench::view
