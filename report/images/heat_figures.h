#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "filters/depth_map.h"
#include "report/images/color_values.h"
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

/// Shows a linear picture, reduced in linear light, its values multiplied by `exposure`. A texel that is not finite
/// becomes magenta.
Image show_picture(const Image& picture, double exposure = 1.0);

/// Shows visibility from black, blocked, to white, lit, reduced by means.
Image show_visibility(const Image& visibility);

/// Shows an image of one channel, with a part of it outlined and magnified below. Where pixels fall together, the worst
/// is shown.
Stack show_part(const Cell& head, const Image& values, const Rect& part, const Badness& badness, const Colors& colors);

/// How dark a value is, for show_part(); what is not finite is worst.
float distance_from_lit(float visibility);

/// Visibility, and its error, signed.
struct ErrorTile {
  std::string title, words;
  Image visibility, error;
};

/// Shows tiles side by side, visibility above errors, which share one scale.
Figure show_errors(const std::string& title, const std::vector<ErrorTile>& tiles);

/// Shows how two pictures differ: the signed difference and, where there is one, the FLIP map, each with its scale.
/// `difference`: 1 channel; NaN where a picture is not finite, infinite where a pixel does not count.
/// `flip`: 1 channel, [0,1], or empty.
std::vector<Stack> show_difference(const Image& difference, const Image& flip);

/// A layer of a depth map: all of it, a cascade, or a face of a cube.
struct DepthLayer {
  Image stored;  ///< one channel, [0,1], row 0 on top; the curve's far plane: nothing was drawn
  std::string name = {};
};

/// Shows every layer of a depth map as it is stored and, where that is not linear depth, after them each linearised:
/// stretched over the values that occur. One of several layers is smaller than the only one.
std::vector<Stack> show_depth(const std::vector<DepthLayer>& layers, const filters::DepthCurve& curve);

/// Shows texels per pixel as colours on a logarithmic scale, 1/64 to 64, with a colour bar. `density`: one channel; 0:
/// turned away from the light or outside the map, -1: background.
Stack show_density(const Image& density);

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
