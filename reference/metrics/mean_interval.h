#pragma once

#include <optional>
#include <span>

namespace shadowbench::metrics {

/// A mean with its 95 % interval.
struct MeanInterval {
  double mean = 0.0;
  double low = 0.0;
  double high = 0.0;
};

/// The mean of values with its 95 % interval by Student's t; nothing for fewer than two values.
std::optional<MeanInterval> find_mean_interval(std::span<const double> values);

}  // namespace shadowbench::metrics
