#pragma once

#include <algorithm>
#include <cmath>

namespace shadowbench::test {

/// A mean with what it may be off by.
struct Estimate {
  double mean = 0.0;
  double slack = 0.0;
};

/// Chance that a whole test of the contract fails although the filter keeps it; every estimate in it gets its share
/// (Bonferroni).
inline constexpr double kTestLevel = 1e-4;

/// Collects independent values in [0,1] and bounds how far their mean is from its expectation.
class MeanInUnitInterval {
 public:
  void add(double value) {
    ++count_;
    sum_ += value;
    squares_ += value * value;
  }

  double mean() const { return sum_ / count_; }

  /// Gives the bound that holds for all of `tests` such means but with the chance kTestLevel. Holds for any
  /// distribution, also where values are not distributed alike: their spread then counts as variance. Requires two
  /// values or more. Source: Maurer and Pontil 2009, Empirical Bernstein Bounds and Sample Variance Penalization, COLT,
  /// theorem 4, on both sides.
  double slack(double tests) const {
    const double variance = std::max(squares_ - sum_ * sum_ / count_, 0.0) / (count_ - 1.0);
    const double log_chance = std::log(4.0 * tests / kTestLevel);
    return std::sqrt(2.0 * variance * log_chance / count_) + 7.0 * log_chance / (3.0 * (count_ - 1.0));
  }

 private:
  double count_ = 0.0;
  double sum_ = 0.0;
  double squares_ = 0.0;
};

}  // namespace shadowbench::test
