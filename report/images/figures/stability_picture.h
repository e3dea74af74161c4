#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <vector>

#include "report/images/image.h"

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

/// A cell's stability, for people.
struct StabilityPicture {
  std::string title;
  std::string note;
  StabilityImages images;
  std::string texels;  ///< caption of the headroom; the next are those of the three images after it
  std::string variance;
  std::string difference;
  std::string bound;
};

/// Draws a heat map with a colour bar for each image there is; where a map or picture is reduced, the worst of the
/// texels that share a pixel is shown. Magenta: overflow, NaN, or a bound broken by more than rounding explains.
/// Requires at least one image. Returns display values, 3 channels. Throws Error(kOutput) where the font is not
/// installed.
Image draw_stability_picture(const StabilityPicture& picture);

/// Writes it as PNG. Throws Error(kOutput).
void write_stability_picture(const std::filesystem::path& path, const StabilityPicture& picture);

}  // namespace shadowbench::images
