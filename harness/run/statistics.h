#pragma once

#include <cstdint>
#include <vector>

#include "report/records.h"

namespace shadowbench::run {

/// Gives median and quartiles, linearly interpolated between order statistics (Hyndman and Fan 1996, type 7).
/// Requires at least one value.
report::Quartiles summarise(std::vector<double> values);

/// Gives the median of the paired ratios numerator[i] / denominator[i] with its 95 % percentile-bootstrap interval
/// (Efron and Tibshirani 1993, An Introduction to the Bootstrap, section 13.3); the same for the same seed.
/// Requires equally many of both, at least one.
report::Ratio bootstrap_ratio(const std::vector<double>& numerator, const std::vector<double>& denominator,
                              std::uint64_t seed);

}  // namespace shadowbench::run
