#include "reference/metrics/error_stats.h"

#include <gsl/gsl_cdf.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numeric>
#include <vector>

namespace shadowbench::metrics {
namespace {

using Parts = std::array<double, kErrorParts>;

double find_mean(std::span<const double> values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

Parts split(const AttributionStations& s, std::size_t i) {
  const double image = static_cast<double>(s.image[i]), kernel = static_cast<double>(s.kernel[i]);
  const double model = s.model.empty() ? image : s.model[i];
  return {image - model, model - s.closer[i], s.closer[i] - kernel, kernel - static_cast<double>(s.area[i])};
}

/// The root of a mean square that sampling made too large by so much.
double take_root(double mean_square, double variance) { return std::sqrt(std::max(mean_square - variance, 0.0)); }

}  // namespace

std::optional<ErrorStats> measure_error(std::span<const float> image, std::span<const float> truth,
                                        std::span<const std::uint8_t> mask, std::span<const float> variance) {
  assert(image.size() == truth.size() && image.size() == mask.size());
  assert(variance.empty() || variance.size() == mask.size());
  ErrorStats stats;
  std::vector<double> distances;
  double sampled = 0.0;
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
    if (!variance.empty()) sampled += static_cast<double>(variance[i]);
  }
  if (distances.empty()) return std::nullopt;
  const double count = static_cast<double>(distances.size());
  stats.count = static_cast<std::int64_t>(distances.size());
  stats.mean /= count;
  stats.mae /= count;
  stats.rmse = take_root(stats.rmse / count, sampled / count);
  const auto rank = static_cast<std::ptrdiff_t>(std::ceil(0.95 * count)) - 1;
  std::nth_element(distances.begin(), distances.begin() + rank, distances.end());
  stats.p95 = distances[static_cast<std::size_t>(rank)];
  stats.max = *std::max_element(distances.begin() + rank, distances.end());
  return stats;
}

double find_student_t(std::size_t count, double below) {
  assert(count >= 2);
  return gsl_cdf_tdist_Pinv(below, static_cast<double>(count - 1));
}

double find_standard_error(std::span<const double> values) {
  assert(values.size() >= 2);
  const double count = static_cast<double>(values.size()), mean = find_mean(values);
  double squares = 0.0;
  for (const double value : values) squares += (value - mean) * (value - mean);
  return std::sqrt(squares / (count - 1.0) / count);
}

std::optional<MeanInterval> find_mean_interval(std::span<const double> values) {
  if (values.size() < 2) return std::nullopt;
  const double mean = find_mean(values), reach = find_student_t(values.size()) * find_standard_error(values);
  return MeanInterval{mean, mean - reach, mean + reach};
}

Attribution attribute_error(const AttributionStations& stations) {
  const std::size_t pixels = stations.mask.size();
  assert(stations.image.size() == pixels && stations.closer.size() == pixels);
  assert(stations.model.empty() || stations.model.size() == pixels);
  assert(stations.kernel.size() == pixels && stations.area.size() == pixels);
  assert(stations.kernel_variance.empty() || stations.kernel_variance.size() == pixels);
  Attribution result;
  for (auto& part : result.parts) part.assign(pixels, 0.0f);
  Parts squares{}, products{};
  double error_squares = 0.0, sampled = 0.0, count = 0.0;
  for (std::size_t i = 0; i < pixels; ++i) {
    if (!stations.mask[i]) continue;
    const Parts parts = split(stations, i);
    const double error = parts[0] + parts[1] + parts[2] + parts[3];
    if (!std::isfinite(error)) {
      ++result.not_finite;
      continue;
    }
    for (std::size_t p = 0; p < kErrorParts; ++p) {
      result.parts[p][i] = static_cast<float>(parts[p]);
      squares[p] += parts[p] * parts[p];
      products[p] += parts[p] * error;
    }
    error_squares += error * error;
    if (!stations.kernel_variance.empty()) sampled += static_cast<double>(stations.kernel_variance[i]);
    count += 1.0;
  }
  for (std::size_t p = 0; p < kErrorParts && error_squares > 0.0; ++p) {
    const bool has_kernel = p >= static_cast<std::size_t>(ErrorPart::kDiscretisation);
    result.stats[p] = PartStats{.rms = take_root(squares[p] / count, has_kernel ? sampled / count : 0.0),
                                .share = products[p] / error_squares};
  }
  if (stations.model.empty()) {
    result.parts.front().clear();
    result.stats.front().reset();
  }
  return result;
}

}  // namespace shadowbench::metrics
