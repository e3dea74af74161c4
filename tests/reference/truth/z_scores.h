#pragma once

// Traced fractions against exact ones, in units of their stated standard errors.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>

#include "reference/truth/visibility.h"

namespace shadowbench::truth {

/// Two-sided z-test of many pixels with 15 degrees of freedom: at a family-wise level of 1e-3 over some 13 000 pixels,
/// Bonferroni asks for the quantile at 3.8e-8 per tail, which is 9.7 for Student's t.
inline constexpr double kCorrectedQuantile = 9.7;

/// The limit of a pixel that is unanimous though its neighbours are not: 256 rays.
inline constexpr double kSmallestLimit = 3.0 / 256.0;

struct ZScores {
  int unanimous = 0;
  int beyond_limit = 0;  ///< unanimous pixels whose exact value lies beyond their 95 % limit
  int at_risk = 0;       ///< pixels that would be beyond it, were they unanimous
  double worst = 0.0;
  double rms = 0.0;
  double squared_errors = 0.0;
  double squared_standard_errors = 0.0;
  int count = 0;

  /// The root mean square of the errors in units of that of the stated standard errors: 1 where these are right.
  double understatement() const { return std::sqrt(squared_errors / squared_standard_errors); }
};

inline ZScores score(const TracedVisibility& truth, const ReceiverImage& image,
                     const std::function<double(const glm::dvec3&)>& exact) {
  ZScores scores;
  for (std::size_t i = 0; i < image.points.size(); ++i) {
    const double expected = exact(glm::dvec3(image.points[i].position_ws));
    const double got = static_cast<double>(truth.visibility[i]);
    if (std::min(expected, 1.0 - expected) > kSmallestLimit) ++scores.at_risk;
    if (truth.unanimous[i]) {
      ++scores.unanimous;
      if (std::abs(got - expected) > 3.0 / truth.rays[i]) ++scores.beyond_limit;
      continue;
    }
    const double error = got - expected, stated = static_cast<double>(truth.standard_error[i]), z = error / stated;
    scores.squared_errors += error * error;
    scores.squared_standard_errors += stated * stated;
    scores.worst = std::max(scores.worst, std::abs(z));
    scores.rms += z * z;
    ++scores.count;
  }
  scores.rms = std::sqrt(scores.rms / scores.count);
  return scores;
}

/// Pools several seeds: the pixels of one seed share sample sets, and their errors are related.
inline ZScores score_seeds(const std::function<TracedVisibility(std::uint32_t)>& trace, const ReceiverImage& image,
                           const std::function<double(const glm::dvec3&)>& exact) {
  ZScores all;
  constexpr std::uint32_t kSeeds = 8;
  for (std::uint32_t seed = 1; seed <= kSeeds; ++seed) {
    const ZScores one = score(trace(seed), image, exact);
    all.unanimous += one.unanimous;
    all.beyond_limit += one.beyond_limit;
    all.at_risk += one.at_risk;
    all.worst = std::max(all.worst, one.worst);
    all.rms += one.count * one.rms * one.rms;
    all.squared_errors += one.squared_errors;
    all.squared_standard_errors += one.squared_standard_errors;
    all.count += one.count;
  }
  all.rms = std::sqrt(all.rms / all.count);
  return all;
}

inline void expect_agreement(const ZScores& scores) {
  std::printf("%d penumbra pixels, rms z %.3f, worst %.2f\n", scores.count, scores.rms, scores.worst);
  EXPECT_GT(scores.count, 500);
  // Of pixels with that much to see, so many may miss it; how many others are rightly unanimous says nothing.
  EXPECT_LE(scores.beyond_limit, 0.05 * scores.at_risk);
  EXPECT_LT(scores.worst, kCorrectedQuantile);
  EXPECT_GT(scores.rms, 0.8);
  EXPECT_LT(scores.rms, 1.25);
}

}  // namespace shadowbench::truth
