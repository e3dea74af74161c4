#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "harness/stress/synthetic_scene.h"

namespace shadowbench::stress {
namespace {

constexpr double kNearlyLit = 1e-3;  // all is lit, or dark: every receiver is this near to it

bool is_all(const std::vector<double>& values, double of) {
  return std::ranges::all_of(
      values, [of](double value) { return std::abs(value - of) < kNearlyLit; });
}

/// The largest fall within a run from any receiver to a later one.
double find_largest_fall(const std::vector<double>& values, std::size_t run) {
  double largest = 0.0;
  for (std::size_t begin = 0; run > 0 && begin + run <= values.size(); begin += run) {
    double highest = values[begin];
    for (std::size_t i = begin; i < begin + run; ++i) {
      highest = std::max(highest, values[i]);
      largest = std::max(largest, highest - values[i]);
    }
  }
  return largest;
}

}  // namespace

double find_largest_error(const std::vector<double>& seen, const std::vector<double>& expected) {
  double largest = 0.0;
  for (std::size_t i = 0; i < seen.size(); ++i) largest = std::max(largest, std::abs(seen[i] - expected[i]));
  return largest;
}

std::optional<Observation> judge_not_finite(const std::vector<double>& visibility) {
  const auto unusable = std::ranges::count_if(visibility, [](double v) { return !std::isfinite(v); });
  if (unusable == 0) return std::nullopt;
  return Observation{Verdict::kBroken, std::nullopt,
                     fmt::format("{} of {} receivers are NaN or infinite", unusable, visibility.size())};
}

Observation judge(const LookupResult& result, const Expected& expected) {
  std::optional<Observation> not_finite = judge_not_finite(result.visibility);
  const double error = find_largest_error(result.visibility, expected.visibility);
  const auto broken = [&](std::string why) {
    return Observation{Verdict::kBroken, not_finite ? std::nullopt : std::optional(error), std::move(why)};
  };
  if (result.broken_texels > 0) return broken(fmt::format("{} texels of the map overflowed", result.broken_texels));
  if (not_finite) return *not_finite;
  for (const auto& [of, name] : {std::pair(1.0, "lit"), std::pair(0.0, "dark")})
    if (is_all(result.visibility, of) && !is_all(expected.visibility, of))
      return broken(fmt::format("all {} receivers are {}", result.visibility.size(), name));
  const double fall = find_largest_fall(result.visibility, expected.rising_run);
  if (fall > kLargestFall) return broken(fmt::format("visibility falls by {:.2g} where it must rise", fall));
  if (error > expected.bound)
    return {Verdict::kDegraded, error, fmt::format("error {:.2g}, over {:g}", error, expected.bound)};
  return {Verdict::kOk, error, {}};
}

}  // namespace shadowbench::stress
