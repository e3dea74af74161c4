#pragma once

#include <string>
#include <utility>
#include <vector>

#include "report/records/records.h"

namespace shadowbench::analysis {

/// Which time is compared, and over which size.
enum class GrowthLaw {
  kLookupOverPixels,    ///< lookup over the picture's pixels
  kLookupOverTexels,    ///< lookup over the map's texels
  kPrefilterOverTexels  ///< prefilter over the map's texels
};

/// How one filter's time grows: the exponents p of time ~ size^p, one per series of cells that differ in the size
/// alone.
struct Growth {
  std::string filter;
  double exponent = 0.0;  ///< the median of the series
  double lowest = 0.0;
  double highest = 0.0;
  int series = 0;
  double from = 0.0;  ///< the smallest size of all series
  double to = 0.0;
};

/// Fits the exponent by least squares in the logarithms of (size, time). Requires two different sizes or more, all
/// positive.
double fit_exponent(const std::vector<std::pair<double, double>>& points);

/// Finds the growth of every filter that has a series of two sizes or more; times are medians.
std::vector<Growth> find_growth(const std::vector<records::CellRecord>& cells, GrowthLaw law);

/// Says in plain sentences how times grow, where the cells hold several sizes: none for a run of one size.
std::vector<std::string> describe_growth(const std::vector<records::CellRecord>& cells);

}  // namespace shadowbench::analysis
