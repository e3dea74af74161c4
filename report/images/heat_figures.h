#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "report/images/figure.h"

namespace shadowbench::images {

/// Images of where one cell's numbers break, or come near to it; rows top to bottom, a map's row 0 is v = 1. One that a
/// filter has no use for is empty.
struct StabilityImages {
  Image headroom;  ///< per texel: natural logarithm that exponents could grow by; not finite where the texel is 0 or
                   ///< broken
  Image variance;  ///< per texel: variance before any clamp
  Image half_difference;  ///< per pixel: visibility, 16-bit store less 32-bit store
  Image shortfall;        ///< per pixel: by how much a bound is darker than what it bounds
  Image violation;        ///< per pixel: the part of the shortfall that rounding does not explain
};

/// Names one of them, for files: "headroom".
struct StabilityImage {
  const char* id;
  Image StabilityImages::*image;
};

/// Lists them in the order of their declaration.
const std::array<StabilityImage, 5>& list_stability_images();

/// Shows a heat map with a colour bar for each of the first four images that there is; where a map or picture is
/// reduced, the worst of the texels that share a pixel is shown. Magenta: overflow, NaN, or a bound broken by more than
/// rounding explains. `captions` are those of the first four.
std::vector<Stack> show_stability(const StabilityImages& images, const std::array<std::string, 4>& captions);

/// Shows how two pictures differ: the signed difference and, where there is one, the FLIP map, each with its scale.
/// `difference`: 1 channel; NaN where a picture is not finite, infinite where a pixel does not count.
/// `flip`: 1 channel, [0,1], or empty.
std::vector<Stack> show_difference(const Image& difference, const Image& flip);

}  // namespace shadowbench::images
