#pragma once

#include "reference/metrics/error_stats.h"
#include "report/regress/comparison.h"

namespace shadowbench::regress {

/// Tests whether a stochastic filter's image, drawn with a seed of its own, is one of those whose mean and deviation
/// the baseline keeps; pixel by pixel, and over blocks of 8 x 8 pixels, where a small shift adds up. `lookups` is how
/// many comparisons a receiver averages. The image's pixels, and lookups, are taken to be independent.
struct SpreadTest {
  metrics::PixelTest pixels;
  metrics::PixelTest blocks;
};
SpreadTest test_spread(const images::Image& image, const images::UncertaintyImages& expected, double lookups,
                       double level);

/// Tests two truths, each with its standard errors; where all rays of a truth agree, it has no such error, and may be
/// off by the limit of 3 in 64 rays.
metrics::PixelTest test_truth(const TruthImages& a, const TruthImages& b, double level);

}  // namespace shadowbench::regress
