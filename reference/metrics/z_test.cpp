#include "reference/metrics/z_test.h"

#include <gsl/gsl_cdf.h>

#include <algorithm>
#include <cmath>

namespace shadowbench::metrics {

double find_p(const NoisyDifference& d) {
  if (!std::isfinite(d.difference) || !std::isfinite(d.variance)) return 0.0;
  if (d.difference == 0.0) return 1.0;
  if (d.variance <= 0.0) return 0.0;
  return 2.0 * gsl_cdf_tdist_Q(std::abs(d.difference) / std::sqrt(d.variance), d.degrees_of_freedom);
}

NoisyDifference add_differences(std::span<const NoisyDifference> differences) {
  NoisyDifference sum{0.0, 0.0, 1.0};
  double spread = 0.0;
  for (const NoisyDifference& each : differences) {
    sum.difference += each.difference;
    sum.variance += each.variance;
    spread += each.variance * each.variance / each.degrees_of_freedom;
  }
  if (spread > 0.0) sum.degrees_of_freedom = sum.variance * sum.variance / spread;
  return sum;
}

double find_p(const Share& a, const Share& b) {
  if (!std::isfinite(a.lit) || !std::isfinite(b.lit)) return 0.0;
  const auto whole = [](double value) { return static_cast<unsigned>(std::llround(std::max(value, 0.0))); };
  const unsigned of_a = whole(a.lookups), of_b = whole(b.lookups);
  const unsigned lit_a = std::min(whole(a.lit), of_a), lit = lit_a + std::min(whole(b.lit), of_b);
  const unsigned dark = of_a + of_b - lit;
  // The number of lit lookups of a, drawn from an urn that holds the lookups of both.
  const double at_most = gsl_cdf_hypergeometric_P(lit_a, lit, dark, of_a);
  const double at_least = lit_a == 0 ? 1.0 : gsl_cdf_hypergeometric_Q(lit_a - 1, lit, dark, of_a);
  return std::min(1.0, 2.0 * std::min(at_most, at_least));
}

PixelTest test_pixels(std::span<const double> probabilities, double level) {
  PixelTest test;
  test.tested = static_cast<std::int64_t>(probabilities.size());
  if (probabilities.empty()) return test;
  test.corrected_level = level / static_cast<double>(probabilities.size());
  test.beyond =
      std::count_if(probabilities.begin(), probabilities.end(), [&](double p) { return p < test.corrected_level; });
  const auto worst = std::min_element(probabilities.begin(), probabilities.end());
  test.worst = static_cast<std::size_t>(worst - probabilities.begin());
  test.smallest_p = *worst;
  return test;
}

}  // namespace shadowbench::metrics
