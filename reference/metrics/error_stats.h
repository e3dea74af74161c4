#pragma once

#include <cstdint>
#include <optional>
#include <span>

namespace shadowbench::metrics {

/// How far an image is from the truth, over the pixels of a mask.
struct ErrorStats {
  std::int64_t count = 0;       ///< pixels that were compared
  std::int64_t not_finite = 0;  ///< pixels of the mask that were left out because the image is NaN or infinite there
  double rmse = 0.0;            ///< root mean square of image - truth
  double mae = 0.0;             ///< mean of |image - truth|
  double p95 = 0.0;             ///< 95th percentile of |image - truth|, nearest rank
  double max = 0.0;             ///< largest |image - truth|
  double mean = 0.0;            ///< signed: positive where the image is brighter than the truth
};

/// Compares an image with the truth where `mask` is not 0.
/// Requires three spans of one length. Gives nothing where the mask holds no finite pixel.
std::optional<ErrorStats> measure_error(std::span<const float> image, std::span<const float> truth,
                                        std::span<const std::uint8_t> mask);

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
