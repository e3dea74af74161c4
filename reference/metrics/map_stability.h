#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace shadowbench::metrics {

/// An encoded map as the GL made it.
struct StoredMap {
  std::vector<float> values;  ///< texels x channels, interleaved
  int channels = 1;
  double largest_number = 0.0;  ///< the largest number that the map's format holds
  bool moments = false;         ///< channels in pairs, a mean and the mean of its square; requires an even number
  /// The same map before its blur, a square, for formats in which a GL may store the largest number instead of
  /// infinity: texels that hold that number have overflowed. Where this is empty, only infinity counts as overflow.
  std::vector<float> before_blur = {};
  int blur_radius_texels = 0;
  std::vector<float> border = {};  ///< what that blur reads outside the map, by channel; empty: no value of its own
};

/// What is wrong with the numbers of an encoded map. min() and clamp() in a lookup hide it in the image.
struct TexelHealth {
  std::int64_t texels = 0;
  std::int64_t overflowed = 0;  ///< texels that overflowed, or into which the blur mixed one that did; none that is NaN
  std::int64_t nan = 0;         ///< texels with a channel that is NaN
  std::optional<double> largest;  ///< largest stored magnitude; empty where a texel is NaN or overflowed
  std::optional<std::int64_t> negative_variance;  ///< texels whose variance is below 0 before any clamp; moments only
  std::optional<double> lowest_variance;          ///< moments only, and only where some texel is finite

  std::int64_t broken() const { return overflowed + nan; }

  /// Adds another layer of the same map.
  void add(const TexelHealth& other);
};

/// Looks through an encoded map.
TexelHealth check_texels(const StoredMap& map);

/// Gives, per texel, ln(largest number) - ln(largest magnitude of the texel's channels): how much larger an exponent
/// could have been; the largest of a 32-bit float is e^88.72. Infinite where the texel is 0, negatively where it
/// overflowed, NaN where it is NaN.
std::vector<float> measure_headroom(const StoredMap& map);

/// Gives, per texel, the mean of the square less the square of the mean, the lowest over the pairs of channels, in
/// single precision as a lookup computes it. Requires moments.
std::vector<float> measure_variance(const StoredMap& map);

/// A bound's image with what it must not be darker than, one value per pixel each.
struct BoundStations {
  std::span<const float> image;       ///< as the GPU made it
  std::span<const double> model;      ///< the filter in double precision
  std::span<const double> closer;     ///< percentage-closer filter of its own kernel and biased depth
  std::span<const double> tolerance;  ///< how far rounding may move the image from the model; NaN: no receiver there
};

/// Where an image breaks its bound, and by how much.
struct BoundCheck {
  std::int64_t receivers = 0;   ///< receivers that were compared: image and tolerance are numbers
  std::int64_t violations = 0;  ///< receivers that are darker by more than rounding explains
  std::int64_t exact_violations =
      0;  ///< receivers where the model in double precision is darker: with these parameters it is no bound
  double shortfall_max = 0.0;    ///< largest closer - image, whether rounding explains it or not
  std::vector<float> shortfall;  ///< per pixel: closer - image where that is positive, else 0
  std::vector<float> violation;  ///< per pixel: the part of the shortfall that is more than the tolerance
};

/// Compares a bound with what it bounds; sums of weights may differ by 1e-6 on either side.
/// Requires spans of one length.
/// Source: Cantelli's inequality for VSM, Markov's for ESM; equality of kernel, map and depth is the caller's part.
BoundCheck check_bound(const BoundStations& stations);

}  // namespace shadowbench::metrics
