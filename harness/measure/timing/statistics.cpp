#include "harness/measure/timing/statistics.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <functional>
#include <iterator>
#include <numbers>

#include "reference/metrics/error_stats.h"

namespace shadowbench::measure {
namespace {

constexpr double kConfidence = 0.95;
constexpr std::size_t kFewestOrdered = 6;  // of fewer values, the least and the most hold the median less often

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

/// Half the width of the interval of a median of fewer values, as of normal ones, whose median is sqrt(pi / 2) as
/// uncertain as their mean; 0 for one.
double find_reach(const std::vector<double>& values) {
  if (values.size() < 2) return 0.0;
  const double t = metrics::find_student_t(values.size(), 0.975);
  return t * std::sqrt(0.5 * std::numbers::pi) * metrics::find_standard_error(values);
}

/// In how many cases of a hundred, as a share, the median lies between the `place`-th smallest and largest of `count`
/// values.
double cover(std::size_t count, std::size_t place) {
  double term = std::exp2(-static_cast<double>(count)), sum = 0.0;  // of as many fair coins, `i` show heads
  for (std::size_t i = 0; i < place; ++i) {
    sum += term;
    term *= static_cast<double>(count - i) / static_cast<double>(i + 1);
  }
  return 1.0 - 2.0 * sum;
}

/// The 95 % interval of the median.
records::Interval find_interval(std::vector<double> values) {
  std::ranges::sort(values);
  const std::size_t count = values.size();
  if (count < kFewestOrdered) {
    const double median = quantile(values, 0.5), reach = find_reach(values);
    return {median - reach, median + reach};
  }
  std::size_t place = 1;
  while (cover(count, place + 1) >= kConfidence) ++place;
  const double wide = cover(count, place), narrow = cover(count, place + 1);
  const double n = static_cast<double>(count), d = static_cast<double>(place);
  const double excess = (wide - kConfidence) / (wide - narrow);
  const double inward = (n - d) * excess / (d + (n - 2.0 * d) * excess);
  return {std::lerp(values[place - 1], values[place], inward),
          std::lerp(values[count - place], values[count - place - 1], inward)};
}

}  // namespace

records::Quartiles summarise(std::vector<double> values) {
  assert(!values.empty());
  std::ranges::sort(values);
  return {quantile(values, 0.5), quantile(values, 0.25), quantile(values, 0.75), static_cast<int>(values.size())};
}

records::Ratio find_ratio(const std::vector<double>& numerator, const std::vector<double>& denominator) {
  const std::vector<double> ratios = divide(numerator, denominator);
  const records::Interval interval = find_interval(ratios);
  return {median_of(ratios), {std::max(0.0, interval.low), interval.high}};
}

records::OwnTime find_difference(const std::vector<double>& minuend, const std::vector<double>& subtrahend) {
  assert(minuend.size() <= subtrahend.size());
  std::vector<double> differences;
  std::ranges::transform(minuend, subtrahend, std::back_inserter(differences), std::minus());
  return {summarise(differences), find_interval(differences)};
}

}  // namespace shadowbench::measure
