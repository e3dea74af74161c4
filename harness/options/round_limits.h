#pragma once

namespace shadowbench::options {

/// When enough rounds are timed.
struct RoundLimits {
  int fewest = 9;
  int most = 200;
  /// How wide the 95 % interval of a filter's ratio to the reference may be, relative to the ratio.
  double precision = 0.05;
  double budget_ms = 400.0;  ///< of timed work for each filter; what a filter does not need is left to the others

  /// Exactly this many rounds, however precise they are.
  static RoundLimits exactly(int rounds) { return {.fewest = rounds, .most = rounds}; }
  bool is_fixed() const { return fewest == most; }
};

}  // namespace shadowbench::options
