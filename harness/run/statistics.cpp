#include "harness/run/statistics.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <random>

namespace shadowbench::run {
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
  std::sort(values.begin(), values.end());
  return quantile(values, 0.5);
}

}  // namespace

report::Quartiles summarise(std::vector<double> values) {
  assert(!values.empty());
  std::sort(values.begin(), values.end());
  return {quantile(values, 0.5), quantile(values, 0.25), quantile(values, 0.75), static_cast<int>(values.size())};
}

report::Ratio bootstrap_ratio(const std::vector<double>& numerator, const std::vector<double>& denominator,
                              std::uint64_t seed) {
  assert(!numerator.empty() && numerator.size() == denominator.size());
  std::vector<double> ratios(numerator.size());
  for (std::size_t i = 0; i < ratios.size(); ++i) ratios[i] = numerator[i] / denominator[i];
  std::mt19937_64 generator(seed);
  std::vector<double> medians;
  std::vector<double> sample(ratios.size());
  for (int i = 0; i < kResamples; ++i) {
    for (double& value : sample) value = ratios[generator() % ratios.size()];
    medians.push_back(median_of(sample));
  }
  std::sort(medians.begin(), medians.end());
  return {median_of(ratios), {quantile(medians, 0.025), quantile(medians, 0.975)}};
}

}  // namespace shadowbench::run
