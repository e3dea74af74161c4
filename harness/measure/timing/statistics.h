#pragma once

#include <cstdint>
#include <vector>

#include "report/records/records.h"

namespace shadowbench::measure {

/// Gives median and quartiles, linearly interpolated between order statistics (Hyndman and Fan 1996, type 7).
/// Requires at least one value.
records::Quartiles summarise(std::vector<double> values);

/// The median of the paired ratios numerator[i] / denominator[i] with its 95 % percentile-bootstrap interval
/// (Efron and Tibshirani 1993, An Introduction to the Bootstrap, section 13.3); the same for the same seed.
/// Requires at least one numerator; of more denominators the first are used. Cost: a millisecond or two.
records::Ratio bootstrap_ratio(const std::vector<double>& numerator, const std::vector<double>& denominator,
                               std::uint64_t seed);

/// The spread of the paired differences minuend[i] - subtrahend[i] with the same interval of their median. Requires at
/// least one minuend; of more subtrahends the first are used.
records::OwnTime bootstrap_difference(const std::vector<double>& minuend, const std::vector<double>& subtrahend,
                                      std::uint64_t seed);

/// The ratio's median with the distribution-free interval between two order statistics that covers it at least 95
/// times in a hundred (David and Nagaraja 2003, Order Statistics, section 7.1); from the least to the most where there
/// are fewer than six ratios, which cover it less often. Microseconds.
records::Ratio order_ratio(const std::vector<double>& numerator, const std::vector<double>& denominator);

}  // namespace shadowbench::measure
