#pragma once

#include <array>

#include "report/images/image.h"

namespace shadowbench::images {

/// In UncertaintyImages::rounding: a comparison may flip here, or another texel be read.
inline constexpr float kMayFlip = 2.0f;

/// Images of how far a cell's pixels may differ from the same filter's on another machine or with another seed; each of
/// 1 channel and the view's size, or empty.
struct UncertaintyImages {
  Image rounding;   ///< bound on what single precision and the GL's filtering weights do to visibility, at most 1; or
                    ///< kMayFlip
  Image seed_mean;  ///< of a stochastic filter: visibility, mean over other seeds than the run's
  Image seed_deviation;  ///< the same: standard deviation over them
};

/// One of them, with its place in a run's float images: "<cell's parts>.<id>".
struct UncertaintyImage {
  const char* id;
  Image UncertaintyImages::*image;
};

inline constexpr std::array<UncertaintyImage, 3> list_uncertainty_images() {
  return {{{"rounding", &UncertaintyImages::rounding},
           {"seed_mean", &UncertaintyImages::seed_mean},
           {"seed_deviation", &UncertaintyImages::seed_deviation}}};
}

/// How many seeds the mean and the deviation are taken over.
inline constexpr int kSpreadSeeds = 16;

}  // namespace shadowbench::images
