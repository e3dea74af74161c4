#pragma once

#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>
#include <numbers>

#include "filters/map_reader.h"
#include "filters/random.h"

namespace shadowbench::filters {

/// How a disk of points is turned at a pixel: `find_turn` and `rotate` of shaders/lib/disk.glsl.
template <class T>
class DiskTurn {
  using P = Position<T>;

 public:
  DiskTurn(const std::string& rotation, const Receiver& r, std::uint32_t seed) {
    const P angle = P(2) * std::numbers::pi_v<P> * static_cast<P>(turn_of(rotation, r.pixel, seed, r.frame));
    cosine_ = std::cos(angle);
    sine_ = std::sin(angle);
  }

  /// Where a point of the unit disk lies in a disk of this radius.
  Offset<T> place(P radius, const glm::vec2& point) const {
    const P x = static_cast<P>(point.x), y = static_cast<P>(point.y);
    return {radius * (cosine_ * x - sine_ * y), radius * (sine_ * x + cosine_ * y)};
  }

 private:
  P cosine_, sine_;
};

/// What filters share whose disk is as wide as the penumbra: shaders/lib/penumbra.glsl.
template <class T>
class PenumbraDisk {
 public:
  using P = Position<T>;
  static constexpr P kOneFetch = P(0.25);  ///< texels: a smaller disk is one fetch
  static constexpr P kRounding = P(1e-4);  ///< of radii and of the places of taps, texels

  explicit PenumbraDisk(const ParamValues& values) : max_radius_(static_cast<P>(number(values, "max_radius"))) {}

  /// The radius in texels of the penumbra that a blocker so far above the receiver makes, in depth, within its limit.
  /// Rounding decides about radii near the end of a single fetch.
  P radius(const Receiver& r, P depth_above, Tally& tally) const {
    const P per_depth =
        P(0.5) * static_cast<P>(r.light_size) * static_cast<P>(r.depth_range_ws) / static_cast<P>(r.texel_size_ws);
    const P limited = std::min(per_depth * depth_above / shrink(r, depth_above), max_radius_);
    if (std::abs(limited - kOneFetch) < kRounding) tally.excused = true;
    return limited;
  }

  /// That radius times a scale, without its limit; the rounding of the blocker's depth is tracked.
  static T widen(const Receiver& r, const T& above, P scale) {
    const P per_depth = scale * P(0.5) * static_cast<P>(r.light_size) * static_cast<P>(r.depth_range_ws) /
                        static_cast<P>(r.texel_size_ws);
    return T(per_depth) * above / T(shrink(r, static_cast<P>(value_of(above))));
  }

  /// The share of the light's distance at which a blocker so far above the receiver is; 1 for a light at infinity.
  static P shrink(const Receiver& r, P depth_above) {
    return std::max(P(1) - depth_above * static_cast<P>(r.depth_range_ws) * static_cast<P>(r.light_nearness), P(1e-4));
  }

  /// The receiver's depth, biased for a tap by the tap's own distance.
  static float biased(const Receiver& r, const Offset<T>& offset) {
    const P bias = static_cast<P>(r.bias_per_texel.x) * std::abs(offset.x) +
                   static_cast<P>(r.bias_per_texel.y) * std::abs(offset.y);
    return static_cast<float>(static_cast<P>(r.depth) - bias);
  }

  /// The depth of the texel at an offset. Near a border between texels rounding decides which one that is: it is
  /// excused where `meaning`, which turns a depth into what it counts as, differs.
  template <class Meaning>
  static float read_depth(const DepthReader<T>& map, const Receiver& r, const Offset<T>& offset, Meaning meaning,
                          Tally& tally) {
    Tally own;
    const float depth = map.fetch_depth(r, offset, own);
    if (!own.excused) return depth;
    for (const P x : {-kRounding, kRounding})
      for (const P y : {-kRounding, kRounding})
        if (meaning(map.fetch_depth(r, {offset.x + x, offset.y + y}, own)) != meaning(depth)) tally.excused = true;
    return depth;
  }

  /// Whether rounding decides which of two depths is the nearer one.
  static bool is_close(float depth, float other) { return std::abs(depth - other) < 1e-7f; }

 private:
  P max_radius_;
};

}  // namespace shadowbench::filters
