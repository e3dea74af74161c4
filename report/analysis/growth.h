#pragma once

#include <utility>
#include <vector>

#include "report/records/records.h"
#include "report/records/text_table.h"

namespace shadowbench::analysis {

/// Fits a line by least squares; returns its slope. Requires two different places or more.
double fit_slope(const std::vector<std::pair<double, double>>& points);

/// Fits the exponent by least squares in the logarithms of (size, time). Requires two different sizes or more, all
/// positive.
double fit_exponent(std::vector<std::pair<double, double>> points);

/// Makes the table of how times (medians) grow with the picture and with the map: a row for each filter, in it the
/// exponents p of time ~ size^p, of each series of cells that differ in the size alone. No columns but the filter's
/// where no cells do.
records::TextTable make_growth_table(const std::vector<records::CellRecord>& cells);

}  // namespace shadowbench::analysis
