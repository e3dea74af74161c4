#pragma once

#include <vector>

#include "report/records/records.h"

namespace shadowbench::measure {

/// Gives median and quartiles, linearly interpolated between order statistics (Hyndman and Fan 1996, type 7).
/// Requires at least one value.
records::Quartiles summarise(std::vector<double> values);

/// The median of the paired ratios numerator[i] / denominator[i] with its 95 % interval, between order statistics
/// (Hettmansperger and Sheather 1986, Confidence Intervals Based on Interpolated Order Statistics, Statistics and
/// Probability Letters 4(2)); of fewer than six ratios by Student's t, and of one the ratio itself. Requires at least
/// one numerator; of more denominators the first are used. Cost: microseconds.
records::Ratio find_ratio(const std::vector<double>& numerator, const std::vector<double>& denominator);

/// The spread of the paired differences minuend[i] - subtrahend[i] with the same interval of their median. Requires at
/// least one minuend; of more subtrahends the first are used.
records::OwnTime find_difference(const std::vector<double>& minuend, const std::vector<double>& subtrahend);

}  // namespace shadowbench::measure
