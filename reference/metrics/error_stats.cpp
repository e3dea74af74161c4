#include "reference/metrics/error_stats.h"

#include <gsl/gsl_cdf.h>
#include <gsl/gsl_statistics_double.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numeric>
#include <vector>

namespace shadowbench::metrics {
namespace {

using Parts = std::array<double, kErrorParts>;

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
  return gsl_stats_sd(values.data(), 1, values.size()) / std::sqrt(static_cast<double>(values.size()));
}

std::optional<MeanInterval> find_mean_interval(std::span<const double> values) {
  if (values.size() < 2) return std::nullopt;
  const double mean = gsl_stats_mean(values.data(), 1, values.size()),
               reach = find_student_t(values.size()) * find_standard_error(values);
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

std::optional<Change> measure_change(std::span<const std::span<const float>> images, std::size_t group,
                                     std::span<const std::uint8_t> mask) {
  assert(group > 0 && images.size() % group == 0);
  const std::size_t groups = images.size() / group;
  const double all = static_cast<double>(images.size()), own = static_cast<double>(group);
  std::vector<double> of_group(groups);  // of the pairs that it is one side of
  std::vector<double> sums(groups), powers(groups);
  std::size_t receivers = 0;
  for (std::size_t i = 0; i < mask.size(); ++i) {
    const auto is_finite = [&](std::span<const float> image) { return std::isfinite(image[i]); };
    if (mask[i] == 0 || !std::ranges::all_of(images, is_finite)) continue;
    ++receivers;
    double sum = 0.0, power = 0.0;
    for (std::size_t g = 0; g < groups; ++g) {
      sums[g] = powers[g] = 0.0;
      for (std::size_t k = g * group; k < (g + 1) * group; ++k) {
        const double value = static_cast<double>(images[k][i]) - static_cast<double>(images[0][i]);
        sums[g] += value;
        powers[g] += value * value;
      }
      sum += sums[g];
      power += powers[g];
    }
    for (std::size_t g = 0; g < groups; ++g)
      of_group[g] += (all - own) * powers[g] + own * (power - powers[g]) - 2.0 * sums[g] * (sum - sums[g]);
  }
  const double squares = 0.5 * std::accumulate(of_group.begin(), of_group.end(), 0.0);
  if (groups < 2 || receivers == 0) return std::nullopt;
  const auto mean_of = [&](double sum, std::size_t count) {
    const double pairs = 0.5 * static_cast<double>(count * (count - 1) * group * group * receivers);
    return std::sqrt(std::max(0.0, sum) / pairs);
  };
  Change change{mean_of(squares, groups)};
  if (groups < 3) return change;
  std::vector<double> pseudo_values;
  for (const double each : of_group)
    pseudo_values.push_back(static_cast<double>(groups) * change.value -
                            static_cast<double>(groups - 1) * mean_of(squares - each, groups - 1));
  const MeanInterval interval = *find_mean_interval(pseudo_values);
  change.reach = interval.high - interval.mean;
  return change;
}

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
