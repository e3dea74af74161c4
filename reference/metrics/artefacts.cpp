#include "reference/metrics/artefacts.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <functional>
#include <vector>

namespace shadowbench::metrics {
namespace {

template <class IsFault>
std::optional<double> rate(std::span<const float> image, std::span<const std::uint8_t> mask, IsFault is_fault) {
  assert(image.size() == mask.size());
  double faults = 0.0, count = 0.0;
  for (std::size_t i = 0; i < image.size(); ++i) {
    if (!mask[i]) continue;
    count += 1.0;
    if (!std::isfinite(image[i]) || is_fault(i)) faults += 1.0;
  }
  if (count < kFewestReceivers) return std::nullopt;
  return faults / count;
}

/// Whether a filter is no brighter than a limit without bias, and brighter by more than that with it.
bool is_lit_by_bias(float biased, float unbiased, double limit) {
  return static_cast<double>(unbiased) <= limit && static_cast<double>(biased - unbiased) > limit;
}

/// Visits the 3 x 3 pixels about one until `visit` says no. False then, and at the image's edge.
template <class Visit>
bool visit_window(std::size_t i, int width, int height, Visit visit) {
  const int x = static_cast<int>(i) % width, y = static_cast<int>(i) / width;
  if (x == 0 || y == 0 || x + 1 == width || y + 1 == height) return false;
  for (int dy = -1; dy <= 1; ++dy) {
    for (int dx = -1; dx <= 1; ++dx)
      if (!visit(static_cast<std::size_t>((y + dy) * width + x + dx))) return false;
  }
  return true;
}

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

ArtefactMasks make_artefact_masks(const RaysAtReceivers& rays) {
  const std::size_t pixels = rays.counts.size();
  const std::vector<std::uint8_t> none(pixels);
  ArtefactMasks masks{.acne = none, .leak = none, .contact_gap = none, .wide_gap = none};
  for (std::size_t i = 0; i < pixels; ++i) {
    if (!rays.counts[i]) continue;
    const bool settled = rays.area_settled[i] && rays.surroundings_settled[i];
    const bool touches = static_cast<double>(rays.first_blocker_texels[i]) <= kArtefactLimits.contact_texels;
    if (settled && rays.ratio[i] == 1.0f && rays.surroundings[i] == 1.0f) masks.acne[i] = 1;
    if (settled && rays.area[i] == 0.0f && rays.surroundings[i] == 0.0f && !touches) masks.leak[i] = 1;
    if (rays.area[i] == 0.0f) (touches ? masks.contact_gap : masks.wide_gap)[i] = 1;
  }
  return masks;
}

std::optional<double> rate_acne(std::span<const float> image, std::span<const float> area,
                                std::span<const std::uint8_t> mask) {
  return rate(
      image, mask,
      [&](std::size_t i) {
        return static_cast<double>(image[i]) < kArtefactLimits.acne_below * static_cast<double>(area[i]);
      });
}

std::optional<double> rate_leak(std::span<const float> image, std::span<const float> unbiased,
                                std::span<const std::uint8_t> mask) {
  constexpr double kLimit = kArtefactLimits.leak_above;
  return rate(image, mask, [&](std::size_t i) {
    return static_cast<double>(image[i]) > kLimit &&
           (unbiased.empty() || !is_lit_by_bias(image[i], unbiased[i], kLimit));
  });
}

std::optional<double> rate_contact_gap(std::span<const float> image, std::span<const float> unbiased,
                                       const ArtefactMasks& masks) {
  if (unbiased.empty()) return std::nullopt;
  constexpr double kLimit = kArtefactLimits.contact_gap_above;
  const auto is_gap = [&](std::size_t i) { return is_lit_by_bias(image[i], unbiased[i], kLimit); };
  std::vector<std::uint8_t> touched(image.size()), wide(image.size());
  for (std::size_t i = 0; i < image.size(); ++i) {
    touched[i] = masks.contact_gap[i] && static_cast<double>(unbiased[i]) <= kLimit ? 1 : 0;
    wide[i] = masks.wide_gap[i] && is_gap(i) ? 1 : 0;
  }
  // A few are texels that miss the blocker, which acne hides without bias.
  if (std::ranges::count(wide, 1) >= kFewestReceivers)
    std::ranges::transform(touched, wide, touched.begin(), std::bit_or());
  return rate(image, touched, is_gap);
}

std::optional<double> rate_noise(std::span<const float> image, std::span<const double> closer,
                                 std::span<const float> kernel, std::span<const std::uint8_t> counts, int width) {
  const int height = static_cast<int>(image.size()) / width;
  double noisy = 0.0, count = 0.0;
  for (std::size_t i = 0; i < image.size(); ++i) {
    if (!counts[i] || !(kernel[i] > 0.0f && kernel[i] < 1.0f)) continue;
    double sum = 0.0;
    const bool whole = visit_window(i, width, height, [&](std::size_t n) {
      sum += static_cast<double>(image[n]) - closer[n];
      return counts[n] != 0;
    });
    if (!whole) continue;
    count += 1.0;
    const double deviation = static_cast<double>(image[i]) - closer[i] - sum / 9.0;
    if (!(std::abs(deviation) <= kArtefactLimits.noise_above)) noisy += 1.0;
  }
  if (count < kFewestReceivers) return std::nullopt;
  return noisy / count;
}

std::optional<double> measure_seam(std::span<const LayerImage> layers, int width,
                                   const std::function<bool(std::size_t, std::size_t)>& is_one_surface) {
  double squares = 0.0, pairs = 0.0;
  /// What taking over from `a` to `b` changes at a pixel of the two; NaN where a layer that does does not reach it.
  const auto find_change = [&](std::size_t a, std::size_t b, std::size_t at) {
    double change = 0.0;
    for (const LayerImage& layer : layers)
      if (const float moved = layer.shares[b] - layer.shares[a]; moved != 0.0f)
        change += static_cast<double>(moved) * static_cast<double>(layer.visibility[at]);
    return change;
  };
  const auto add = [&](std::size_t a, std::size_t b) {
    const auto shares_alike = [&](const LayerImage& each) {
      return std::abs(each.shares[a] - each.shares[b]) < kArtefactLimits.seam_share;
    };
    if (std::ranges::all_of(layers, shares_alike)) return;
    if (!is_one_surface(a, b)) return;
    for (const std::size_t at : {a, b}) {
      const double change = find_change(a, b, at);
      if (!std::isfinite(change)) continue;
      squares += change * change;
      pairs += 1.0;
    }
  };
  const auto across = static_cast<std::size_t>(width), pixels = layers.front().shares.size();
  const auto step = static_cast<std::size_t>(std::max(1.0, std::round(kArtefactLimits.seam_step * width)));
  for (std::size_t i = 0; i < pixels; ++i) {
    if (i % across + step < across) add(i, i + step);
    if (i + step * across < pixels) add(i, i + step * across);
  }
  if (pairs < kFewestReceivers) return std::nullopt;
  return std::sqrt(squares / pairs);
}

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
