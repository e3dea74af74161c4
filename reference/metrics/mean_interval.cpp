#include "reference/metrics/mean_interval.h"

#include <gsl/gsl_cdf.h>

#include <cmath>
#include <numeric>

namespace shadowbench::metrics {

std::optional<MeanInterval> find_mean_interval(std::span<const double> values) {
  if (values.size() < 2) return std::nullopt;
  const double count = static_cast<double>(values.size());
  const double mean = std::accumulate(values.begin(), values.end(), 0.0) / count;
  double squares = 0.0;
  for (const double value : values) squares += (value - mean) * (value - mean);
  const double of_difference = std::sqrt(2.0 * squares / (count - 1.0) / count);
  const double reach = gsl_cdf_tdist_Pinv(0.975, count - 1.0) * of_difference;
  return MeanInterval{mean, mean - reach, mean + reach};
}

}  // namespace shadowbench::metrics
