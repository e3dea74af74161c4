#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "filters/depth_map.h"
#include "report/images/figure.h"
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

/// Shows a heat map with a colour bar for each of the first four images that there is; where a map or picture is
/// reduced, the worst of the texels that share a pixel is shown. Magenta: overflow, NaN, or a bound broken by more than
/// rounding explains. `captions` are those of the first four.
std::vector<Stack> show_stability(const StabilityImages& images, const std::array<std::string, 4>& captions);

/// Shows how two pictures differ: the signed difference and, where there is one, the FLIP map, each with its scale.
/// `difference`: 1 channel; NaN where a picture is not finite, infinite where a pixel does not count.
/// `flip`: 1 channel, [0,1], or empty.
std::vector<Stack> show_difference(const Image& difference, const Image& flip);

/// A layer of a depth map: all of it, a cascade, or a face of a cube.
struct DepthLayer {
  Image stored;          ///< one channel, [0,1], row 0 on top; the curve's far plane: nothing was drawn
  double range_m = 0.0;  ///< metres from depth 0 to depth 1
  std::string name = {};
};

/// How often depths occur.
struct DepthHistogram {
  std::vector<std::int64_t> counts;  ///< of texels, in equal bins over [0,1]
  std::int64_t empty = 0;            ///< texels that hold `far_plane`, in no bin
};

/// Counts depths. Requires one channel and at least one bin; depths outside [0,1] go to the nearest bin.
DepthHistogram count_depths(const Image& depth, int bins, float far_plane = 1.0f);

/// Shows every layer of a depth map as it is stored and, where that is not linear depth, after them each linearised:
/// stretched over the values that occur, with its histogram below, texels per bin on a logarithmic axis over value and
/// metres. One of several layers is smaller than the only one.
std::vector<Stack> show_depth(const std::vector<DepthLayer>& layers, const filters::DepthCurve& curve);

/// Shows texels per pixel as colours on a logarithmic scale, 1/64 to 64, with a colour bar. `density`: one channel; 0:
/// turned away from the light or outside the map, -1: background.
Stack show_density(const Image& density);

/// Chooses how many texels a side of a chessboard's field has: the smallest power of two, 1 or more, for which the
/// median field of a receiver covers 36 pixels; 1 where no receiver faces the light.
int choose_field_texels(const Image& density);

/// Shows the map's texels on the surfaces as a chessboard whose dark fields darken the picture, each of
/// choose_field_texels() a side, which the words say. Where fields are smaller than 4 pixels the pattern fades, and it
/// is gone where they are smaller than 2: it would show the pixels' grid instead.
/// `picture`: linear RGB; `texel`: place in the map in texels, two channels; `density`: as show_density().
Stack show_texels(const Image& picture, const Image& texel, const Image& density);

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
