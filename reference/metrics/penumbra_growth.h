#pragma once

#include <cstdint>
#include <optional>
#include <span>

namespace shadowbench::metrics {

/// Penumbrae of an image beside those of the truth.
struct Penumbrae {
  std::span<const std::span<const float>> images;  ///< visibility, by the places of the map's grid: their mean counts
  std::span<const float> truth;                    ///< visibility of the whole light
  std::span<const std::uint8_t> mask;              ///< 1 where a pixel counts
  std::span<const float> width_ws;  ///< metres, of the penumbra that a receiver's blocker throws on it; infinity: none
  double texel_ws = 1.0;            ///< side of the map's texels, metres
  int columns = 0;                  ///< of the images
};

/// Which penumbrae tell how they grow.
struct GrowthLimits {
  int tile_pixels = 16;
  double least_texels = 2.0;   ///< narrower ones are as wide as the map's texels make them
  double most_texels = 24.0;   ///< wider ones are cut by a filter's `max_radius`, which is 12 where nobody changes it
  double least_pixels = 2.0;   ///< of penumbra in a tile
  int fewest_tiles = 12;       ///< that have so much
  double least_spread = 0.25;  ///< standard deviation of the widths' logarithms: a quarter is a factor of two and more
};
inline constexpr GrowthLimits kGrowthLimits;

/// Measures by how much the width of an image's penumbrae grows where that of the truth's grows by 1: 1 is as the
/// truth, 0 one width for all, below 0 the wrong way round.
///
/// The sum of v (1 - v) over a tile is the length of the edges in it times a sixth of their penumbrae's width, whatever
/// noise of mean 0 is in v. So the image's sum over the truth's, times the width that the blockers' distance gives, is
/// the width of its penumbrae. The growth is the slope of the line through these over the latter; each length of
/// edge weighs the same. Nothing where too little of the view tells.
std::optional<double> measure_penumbra_growth(const Penumbrae& penumbrae);

}  // namespace shadowbench::metrics
