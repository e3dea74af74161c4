#pragma once

#include "filters/map_reader.h"

namespace shadowbench::filters {

/// The end of a lookup whose first taps agree: shaders/lib/early_bail.glsl.
class EarlyBail {
 public:
  explicit EarlyBail(const ParamValues& values) : bails_(text_or(values, "bail", "none") == "agree") {}

  /// The tap of so many that comes i-th.
  std::size_t order(std::size_t i, std::size_t count) const { return bails_ ? count - 1 - i : i; }

  /// Whether the first taps, of which i is the last so far, are all lit or all blocked; excused where a weight that is
  /// as good as none keeps them from it.
  bool agrees(std::size_t i, double sum, Tally& tally) const {
    if (!bails_ || i + 1 != kFirstTaps) return false;
    const double from_end = std::min(sum, static_cast<double>(kFirstTaps) - sum);
    if (from_end != 0.0 && from_end < kRounding) tally.excused = true;
    return from_end == 0.0;
  }

 private:
  static constexpr std::size_t kFirstTaps = 4;
  static constexpr double kRounding = 1e-3;

  bool bails_;
};

}  // namespace shadowbench::filters
