#pragma once

namespace shadowbench::options {

/// Says when enough rounds are timed.
struct RoundLimits {
  int fewest = 9;
  int most = 200;
  /// Wanted width of the 95 % interval of a filter's ratio to the reference, over the ratio; 0: always `most` rounds.
  double precision = 0.05;
  double budget_ms = 400.0;  ///< of timed work for each filter; those that need less leave the rest to the others

  /// As many rounds as that, whatever they say.
  static RoundLimits exactly(int rounds) { return {rounds, rounds, 0.0, 0.0}; }
  bool is_fixed() const { return precision <= 0.0; }
};

}  // namespace shadowbench::options
