#include "harness/measure/timing/statistics.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <functional>
#include <iterator>
#include <random>

namespace shadowbench::measure {
namespace {

constexpr int kResamples = 2000;

double quantile(const std::vector<double>& sorted, double q) {
  const double position = q * static_cast<double>(sorted.size() - 1);
  const auto below = static_cast<std::size_t>(std::floor(position));
  const std::size_t above = std::min(below + 1, sorted.size() - 1);
  const double fraction = position - static_cast<double>(below);
  return sorted[below] + fraction * (sorted[above] - sorted[below]);
}

double median_of(std::vector<double> values) {
  std::ranges::sort(values);
  return quantile(values, 0.5);
}

std::vector<double> divide(const std::vector<double>& numerator, const std::vector<double>& denominator) {
  assert(!numerator.empty() && numerator.size() <= denominator.size());
  std::vector<double> ratios(numerator.size());
  for (std::size_t i = 0; i < ratios.size(); ++i) ratios[i] = numerator[i] / denominator[i];
  return ratios;
}

/// How many of `count` values may lie on one side of the interval: the most that fewer than 2.5 % of the throws
/// of as many fair coins do not exceed.
std::size_t count_outside(std::size_t count) {
  double term = std::exp2(-static_cast<double>(count)), sum = term;  // no coin shows heads
  std::size_t outside = 0;
  while (sum <= 0.025) {
    ++outside;
    term *= static_cast<double>(count - outside + 1) / static_cast<double>(outside);
    sum += term;
  }
  return outside;
}

/// The 95 % percentile-bootstrap interval of the median.
records::Interval bootstrap_median(const std::vector<double>& values, std::uint64_t seed) {
  std::mt19937_64 generator(seed);
  std::vector<double> medians;
  std::vector<double> sample(values.size());
  for (int i = 0; i < kResamples; ++i) {
    for (double& value : sample) value = values[generator() % values.size()];
    medians.push_back(median_of(sample));
  }
  std::ranges::sort(medians);
  return {quantile(medians, 0.025), quantile(medians, 0.975)};
}

}  // namespace

records::Quartiles summarise(std::vector<double> values) {
  assert(!values.empty());
  std::ranges::sort(values);
  return {quantile(values, 0.5), quantile(values, 0.25), quantile(values, 0.75), static_cast<int>(values.size())};
}

records::Ratio bootstrap_ratio(const std::vector<double>& numerator, const std::vector<double>& denominator,
                               std::uint64_t seed) {
  const std::vector<double> ratios = divide(numerator, denominator);
  return {median_of(ratios), bootstrap_median(ratios, seed)};
}

records::OwnTime bootstrap_difference(const std::vector<double>& minuend, const std::vector<double>& subtrahend,
                                      std::uint64_t seed) {
  assert(minuend.size() <= subtrahend.size());
  std::vector<double> differences;
  std::ranges::transform(minuend, subtrahend, std::back_inserter(differences), std::minus());
  return {summarise(differences), bootstrap_median(differences, seed)};
}

records::Ratio order_ratio(const std::vector<double>& numerator, const std::vector<double>& denominator) {
  std::vector<double> ratios = divide(numerator, denominator);
  std::ranges::sort(ratios);
  // With l values outside, the interval runs from the l-th smallest to the l-th largest value.
  const std::size_t outside = std::max<std::size_t>(count_outside(ratios.size()), 1);
  return {quantile(ratios, 0.5), {ratios[outside - 1], ratios[ratios.size() - outside]}};
}

}  // namespace shadowbench::measure
