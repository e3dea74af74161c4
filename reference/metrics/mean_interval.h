#pragma once

#include <optional>
#include <span>

namespace shadowbench::metrics {

/// A mean with the interval in which the mean of as many other values lies in 95 of 100 cases.
struct MeanInterval {
  double mean = 0.0;
  double low = 0.0;
  double high = 0.0;
};

/// The mean of values with its 95 % prediction interval by Student's t (Hahn and Meeker 1991, Statistical Intervals,
/// section 4.8): two means of one thing differ by sqrt(2) of what each is uncertain. Nothing for fewer than two values.
std::optional<MeanInterval> find_mean_interval(std::span<const double> values);

}  // namespace shadowbench::metrics
