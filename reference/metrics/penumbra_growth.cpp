#include "reference/metrics/penumbra_growth.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace shadowbench::metrics {
namespace {

/// What a tile has of penumbrae, in pixels.
struct Tile {
  double image = 0.0;
  double truth = 0.0;
  double weight = 0.0;  ///< the part of `truth` whose width is known
  double width = 0.0;   ///< its mean, texels, once divided by `weight`
};

double edge_of(double v) { return v * (1.0 - v); }

std::vector<Tile> sum_tiles(const Penumbrae& p) {
  const auto columns = static_cast<std::size_t>(p.columns), side = static_cast<std::size_t>(kGrowthLimits.tile_pixels);
  const std::size_t tiles_per_row = (columns + side - 1) / side, rows = p.mask.size() / columns;
  std::vector<Tile> tiles(tiles_per_row * ((rows + side - 1) / side));
  for (std::size_t i = 0; i < p.mask.size(); ++i) {
    double mean = 0.0;
    for (const std::span<const float> image : p.images)
      mean += static_cast<double>(image[i]) / static_cast<double>(p.images.size());
    if (p.mask[i] == 0 || !std::isfinite(mean)) continue;
    Tile& tile = tiles[i / columns / side * tiles_per_row + i % columns / side];
    const double own = edge_of(static_cast<double>(p.truth[i]));
    tile.image += edge_of(mean);
    tile.truth += own;
    if (!std::isfinite(p.width_ws[i])) continue;
    tile.weight += own;
    tile.width += own * static_cast<double>(p.width_ws[i]) / p.texel_ws;
  }
  for (Tile& tile : tiles)
    if (tile.weight > 0.0) tile.width /= tile.weight;
  return tiles;
}

bool tells(const Tile& tile) {
  return tile.truth >= kGrowthLimits.least_pixels && tile.width >= kGrowthLimits.least_texels &&
         tile.width <= kGrowthLimits.most_texels;
}

/// A line through points of different weights.
struct Line {
  double sum = 0.0, x = 0.0, y = 0.0, xx = 0.0, xy = 0.0;

  void add(double weight, double at, double value) {
    sum += weight;
    x += weight * at;
    y += weight * value;
    xx += weight * at * at;
    xy += weight * at * value;
  }
  double deviation() const { return std::sqrt(xx / sum - x / sum * (x / sum)); }
  double slope() const { return (sum * xy - x * y) / (sum * xx - x * x); }
};

}  // namespace

std::optional<double> measure_penumbra_growth(const Penumbrae& penumbrae) {
  std::vector<Tile> tiles = sum_tiles(penumbrae);
  std::erase_if(tiles, [](const Tile& tile) { return !tells(tile); });
  Line widths, logarithms;
  for (const Tile& tile : tiles) {
    const double edge = tile.truth / tile.width;  // proportional to its length
    widths.add(edge, tile.width, tile.image / tile.truth * tile.width);
    logarithms.add(edge, std::log(tile.width), 0.0);
  }
  const bool tell =
      std::ssize(tiles) >= kGrowthLimits.fewest_tiles && logarithms.deviation() >= kGrowthLimits.least_spread;
  return tell ? std::optional(widths.slope()) : std::nullopt;
}

}  // namespace shadowbench::metrics
