#include "reference/metrics/error_stats.h"

#include <gsl/gsl_cdf.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numeric>
#include <vector>

namespace shadowbench::metrics {

std::optional<ErrorStats> measure_error(std::span<const float> image, std::span<const float> truth,
                                        std::span<const std::uint8_t> mask) {
  assert(image.size() == truth.size() && image.size() == mask.size());
  ErrorStats stats;
  std::vector<double> distances;
  for (std::size_t i = 0; i < image.size(); ++i) {
    if (!mask[i]) continue;
    const double error = static_cast<double>(image[i]) - static_cast<double>(truth[i]);
    if (!std::isfinite(error)) {
      ++stats.not_finite;
      continue;
    }
    distances.push_back(std::abs(error));
    stats.mean += error;
    stats.rmse += error * error;
    stats.mae += std::abs(error);
  }
  if (distances.empty()) return std::nullopt;
  const double count = static_cast<double>(distances.size());
  stats.count = static_cast<std::int64_t>(distances.size());
  stats.mean /= count;
  stats.mae /= count;
  stats.rmse = std::sqrt(stats.rmse / count);
  const auto rank = static_cast<std::ptrdiff_t>(std::ceil(0.95 * count)) - 1;
  std::nth_element(distances.begin(), distances.begin() + rank, distances.end());
  stats.p95 = distances[static_cast<std::size_t>(rank)];
  stats.max = *std::max_element(distances.begin() + rank, distances.end());
  return stats;
}

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
