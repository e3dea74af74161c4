#pragma once

#include <cstdint>

#include "report/images/uncertainty_images.h"

namespace shadowbench::regress {

/// A rounding bound of this size or more says nothing about its pixel.
inline constexpr float kWidestBound = 0x1p-5f;

/// One cell's visibility, with how far rounding and other seeds can move it. All images have one size or are empty.
struct CellImages {
  images::Image visibility;
  images::UncertaintyImages uncertainty;
};

/// Coarsens rounding bounds to what a baseline keeps: 0 below 2^-14; the next power of two above; 1 from kWidestBound
/// on; images::kMayFlip stays.
images::Image coarsen_rounding(const images::Image& rounding);

/// How an image differs from the expected one.
struct PixelChange {
  std::int64_t compared = 0;          ///< pixels that were compared
  std::int64_t changed = 0;           ///< compared pixels that differ by more than their tolerance, or are not finite
  std::int64_t excused_flips = 0;     ///< left out: a comparison may flip there, or another texel be read
  std::int64_t excused_rounding = 0;  ///< left out: rounding alone may move them by kWidestBound or more
  std::int64_t excused_expected = 0;  ///< pixels that the baseline alone leaves out
  std::int64_t excused_changed = 0;   ///< pixels left out that do differ by more than the tolerance, of those that
                                      ///< rounding moves far by more than with two bounds of kWidestBound
  double excused_squares = 0.0;       ///< sum of the squared differences of the pixels left out
  double max = 0.0;                   ///< largest difference of a pixel that was compared
  int max_x = 0;                      ///< its column from the left and its row from the top
  int max_y = 0;
  double mean = 0.0;  ///< mean magnitude over the compared pixels
  double rms = 0.0;

  std::int64_t pixels() const { return compared + excused_flips + excused_rounding; }
  double share() const { return compared > 0 ? static_cast<double>(changed) / static_cast<double>(compared) : 0.0; }
};

/// Compares images of one size. A pixel may differ by `tolerance` and the rounding bounds of both, where one of 0
/// counts as the 2^-14 that it may stand for: `tolerance` is spent on how images are stored. On the processor depends
/// whether a product and a sum are rounded once or twice, which moves a map's coordinates by 2^-24, and the filtering
/// weights of 512 texels by 2^-15.
PixelChange compare_pixels(const CellImages& actual, const CellImages& expected, double tolerance);

}  // namespace shadowbench::regress
