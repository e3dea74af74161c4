#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "reference/metrics/metric_table.h"
#include "report/images/image.h"

namespace shadowbench::run {

/// Which pictures to compare, and how. A picture's name is FILE or FILE#PART, in any format that OpenImageIO
/// reads.
struct ComparisonOptions {
  std::string image;
  std::string truth;
  std::optional<std::string> mask;       ///< pixels count where it is not 0; empty: all do
  std::vector<metrics::Metric> metrics;  ///< out of metrics::picture_metrics()
  double pixels_per_degree = 0.0;        ///< for FLIP; positive
  bool images = false;                   ///< give `difference` and `flip` too
};

/// What a comparison gave.
struct Comparison {
  int width = 0;
  int height = 0;
  int channels = 0;                           ///< alpha left out
  std::int64_t compared = 0;                  ///< pixels that count and are finite in both pictures
  std::int64_t not_finite = 0;                ///< pixels that count, but are NaN or infinite in a picture: left out
  std::map<std::string, double> values;       ///< by metric's name, image less truth; only those that exist
  std::map<std::string, std::string> absent;  ///< metric's name to why it does not exist
  std::vector<std::string> warnings;
  images::Image difference;  ///< 1 channel: the means over the channels, first less second; NaN where one is not
                             ///< finite, infinite where a pixel does not count
  images::Image flip;        ///< 1 channel; empty where there is none
};

/// Compares two pictures as a run compares its own: measure_error() over all channels of the values as stored, and
/// measure_mean_flip() of the whole pictures in linear RGB (sRGB codes are decoded, one channel is grey). Alpha is left
/// out. Pixels that are not finite are counted, never averaged in.
/// Throws Error(kInput): a picture cannot be read, sizes or channels differ, a mask that is not one finite channel.
/// Cost: FLIP takes about a second per megapixel.
Comparison compare_pictures(const ComparisonOptions& options);

}  // namespace shadowbench::run
