#pragma once

#include <cstdint>
#include <span>

namespace shadowbench::metrics {

/// The difference of two measurements of one pixel, and how much chance may contribute to it.
struct NoisyDifference {
  double difference = 0.0;
  double variance = 0.0;            ///< variance of the difference; 0: the two must be equal
  double degrees_of_freedom = 1.0;  ///< degrees of freedom of the variance's estimate
};

/// The probability, two-sided, of such a difference or a larger one by chance; 0 for one that is not finite.
/// Source: Student 1908, The Probable Error of a Mean.
double find_p(const NoisyDifference& difference);

/// Adds differences that are independent of each other; the degrees of freedom of the sum's variance follow
/// Satterthwaite 1946, An Approximate Distribution of Estimates of Variance Components.
NoisyDifference add_differences(std::span<const NoisyDifference> differences);

/// How many lookups were lit, out of how many.
struct Share {
  double lit = 0.0;
  double lookups = 0.0;
};

/// The two-sided probability that two shares differ at least so much where both come from one probability,
/// whatever that is: it is right for few lookups, and where nearly all agree. Counts are rounded to whole numbers.
/// Source: Fisher 1935, The Logic of Inductive Inference (the exact test), twice its one-sided value.
double find_p(const Share& a, const Share& b);

/// Whether chance explains the differences of many pixels.
struct PixelTest {
  std::int64_t tested = 0;
  std::int64_t beyond = 0;       ///< pixels that differ by more than chance explains at the corrected level
  std::size_t worst = 0;         ///< index of the least likely difference
  double smallest_p = 1.0;       ///< its probability, not corrected
  double corrected_level = 0.0;  ///< the level divided by the number of tests: a smaller probability is beyond chance
};

/// Tests every pixel's probability at `level`, corrected for their number: the probability that any is found where all
/// are chance is at most `level`. Source: Bonferroni's inequality.
PixelTest test_pixels(std::span<const double> probabilities, double level);

}  // namespace shadowbench::metrics
