#include "reference/metrics/map_stability.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

namespace shadowbench::metrics {
namespace {

constexpr double kWeightSlack = 1e-6;  // the kernel's weights are single precision, and their sum is off by this much

std::size_t count_texels(const StoredMap& map) { return map.values.size() / static_cast<std::size_t>(map.channels); }

std::span<const float> texel(std::span<const float> values, std::size_t i, int channels) {
  return values.subspan(i * static_cast<std::size_t>(channels), static_cast<std::size_t>(channels));
}
std::span<const float> texel(const StoredMap& map, std::size_t i) { return texel(map.values, i, map.channels); }

/// The largest magnitude of a texel's channels; NaN where a channel is NaN, which std::max would pass over.
float find_largest(std::span<const float> channels) {
  float largest = 0.0f;
  for (const float value : channels) {
    if (std::isnan(value)) return value;
    largest = std::max(largest, std::abs(value));
  }
  return largest;
}

/// Spreads the marks to `radius` texels on either side, along rows or columns.
std::vector<std::uint8_t> spread(const std::vector<std::uint8_t>& marked, std::size_t side, int radius,
                                 bool along_rows) {
  std::vector<std::uint8_t> result(marked.size(), 0);
  const auto last = static_cast<std::ptrdiff_t>(side) - 1;
  for (std::size_t i = 0; i < marked.size(); ++i) {
    if (!marked[i]) continue;
    const auto at = static_cast<std::ptrdiff_t>(along_rows ? i % side : i / side);
    const std::ptrdiff_t from = std::max<std::ptrdiff_t>(at - radius, 0),
                         to = std::min<std::ptrdiff_t>(at + radius, last);
    for (std::ptrdiff_t t = from; t <= to; ++t) {
      result[along_rows ? i - i % side + static_cast<std::size_t>(t) : static_cast<std::size_t>(t) * side + i % side] =
          1;
    }
  }
  return result;
}

/// Marks the texels whose blur reads what lies outside the map.
void mark_rim(std::vector<std::uint8_t>& marked, std::size_t side, int radius) {
  const auto width = static_cast<std::size_t>(radius);
  for (std::size_t i = 0; i < marked.size(); ++i) {
    const std::size_t x = i % side, y = i / side;
    if (std::min({x, y, side - 1 - x, side - 1 - y}) < width) marked[i] = 1;
  }
}

/// Marks the texels that overflowed before the blur, and those that the blur mixed them into; empty where none did.
std::vector<std::uint8_t> find_saturated(const StoredMap& map) {
  std::vector<std::uint8_t> marked(map.before_blur.size() / static_cast<std::size_t>(map.channels));
  const auto is_saturated = [&](std::span<const float> channels) {
    return static_cast<double>(find_largest(channels)) >= map.largest_number;
  };
  bool any = false;
  for (std::size_t i = 0; i < marked.size(); ++i) {
    marked[i] = is_saturated(texel(map.before_blur, i, map.channels)) ? 1 : 0;
    any = any || marked[i];
  }
  const auto side = static_cast<std::size_t>(std::lround(std::sqrt(static_cast<double>(marked.size()))));
  const bool border = !marked.empty() && is_saturated(map.border);
  if (any) marked = spread(spread(marked, side, map.blur_radius_texels, true), side, map.blur_radius_texels, false);
  if (border) mark_rim(marked, side, map.blur_radius_texels);
  return any || border ? marked : std::vector<std::uint8_t>();
}

bool is_marked(const std::vector<std::uint8_t>& marks, std::size_t i) { return !marks.empty() && marks[i]; }

float find_variance(std::span<const float> channels) {
  float lowest = std::numeric_limits<float>::infinity();
  for (std::size_t c = 0; c + 1 < channels.size(); c += 2) {
    const float variance = channels[c + 1] - channels[c] * channels[c];
    if (std::isnan(variance)) return variance;
    lowest = std::min(lowest, variance);
  }
  return lowest;
}

void check_variances(const StoredMap& map, TexelHealth& health) {
  health.negative_variance = 0;
  for (std::size_t i = 0; i < count_texels(map); ++i) {
    const float variance = find_variance(texel(map, i));
    if (!std::isfinite(variance)) continue;
    if (variance < 0.0f) ++*health.negative_variance;
    health.lowest_variance = std::min(health.lowest_variance.value_or(HUGE_VAL), static_cast<double>(variance));
  }
}

}  // namespace

void TexelHealth::add(const TexelHealth& other) {
  texels += other.texels;
  overflowed += other.overflowed;
  nan += other.nan;
  if (largest) largest = other.largest ? std::optional(std::max(*largest, *other.largest)) : std::nullopt;
  if (negative_variance) *negative_variance += other.negative_variance.value_or(0);
  if (!lowest_variance || (other.lowest_variance && *other.lowest_variance < *lowest_variance))
    lowest_variance = other.lowest_variance;
}

TexelHealth check_texels(const StoredMap& map) {
  TexelHealth health;
  const std::vector<std::uint8_t> saturated = find_saturated(map);
  double largest = 0.0;
  for (std::size_t i = 0; i < count_texels(map); ++i) {
    const float here = find_largest(texel(map, i));
    ++health.texels;
    if (std::isnan(here))
      ++health.nan;
    else if (std::isinf(here) || is_marked(saturated, i))
      ++health.overflowed;
    else
      largest = std::max(largest, static_cast<double>(here));
  }
  if (health.broken() == 0) health.largest = largest;
  if (map.moments) check_variances(map, health);
  return health;
}

std::vector<float> measure_headroom(const StoredMap& map) {
  const std::vector<std::uint8_t> saturated = find_saturated(map);
  std::vector<float> headroom(count_texels(map));
  for (std::size_t i = 0; i < headroom.size(); ++i) {
    const auto here = static_cast<double>(find_largest(texel(map, i)));
    headroom[i] = static_cast<float>(std::log(map.largest_number) - std::log(here));
    if (is_marked(saturated, i) && !std::isnan(here)) headroom[i] = -std::numeric_limits<float>::infinity();
  }
  return headroom;
}

std::vector<float> measure_variance(const StoredMap& map) {
  assert(map.moments && map.channels % 2 == 0);
  std::vector<float> variance(count_texels(map));
  for (std::size_t i = 0; i < variance.size(); ++i) variance[i] = find_variance(texel(map, i));
  return variance;
}

BoundCheck check_bound(const BoundStations& stations) {
  const std::size_t pixels = stations.image.size();
  assert(stations.model.size() == pixels && stations.closer.size() == pixels && stations.tolerance.size() == pixels);
  BoundCheck check;
  check.shortfall.assign(pixels, 0.0f);
  check.violation.assign(pixels, 0.0f);
  for (std::size_t i = 0; i < pixels; ++i) {
    const auto image = static_cast<double>(stations.image[i]);
    const double tolerance = stations.tolerance[i];
    if (std::isnan(tolerance) || !std::isfinite(image)) continue;
    ++check.receivers;
    if (stations.model[i] < stations.closer[i] - kWeightSlack) ++check.exact_violations;
    const double shortfall = stations.closer[i] - image;
    if (shortfall <= kWeightSlack) continue;
    check.shortfall[i] = static_cast<float>(shortfall);
    check.shortfall_max = std::max(check.shortfall_max, shortfall);
    if (shortfall <= tolerance + kWeightSlack) continue;
    check.violation[i] = static_cast<float>(shortfall - tolerance);
    ++check.violations;
  }
  return check;
}

}  // namespace shadowbench::metrics
