#pragma once

#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>
#include <numbers>
#include <vector>

#include "filters/encoded_map.h"
#include "filters/map_reader.h"
#include "filters/model.h"
#include "filters/random.h"

namespace shadowbench::filters {

/// The points `disk_points` of a filter that turns them by its parameter `rotation`.
struct TurnedDisk {
  std::vector<glm::vec2> points;
  std::string rotation;
  std::uint32_t seed;

  explicit TurnedDisk(const ModelInput& input)
      : points(generate_disk_points(input.spec, input.values, "disk_points")),
        rotation(text_or(input.values, "rotation", "none")),
        seed(input.seed) {}
};

/// How a disk is turned at a pixel: `find_turn` and `rotate` of shaders/lib/disk.glsl.
template <class T>
class DiskTurn {
  using P = Position<T>;

 public:
  DiskTurn(const TurnedDisk& disk, const Receiver& r) {
    const P angle = P(2) * std::numbers::pi_v<P> * static_cast<P>(turn_of(disk.rotation, r.pixel, disk.seed, r.frame));
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

/// What filters share that read means over boxes as wide as the penumbra: shaders/lib/penumbra_box.glsl.
template <class T, std::size_t N>
class PenumbraBox {
  using P = Position<T>;

 public:
  template <class Encode>
  PenumbraBox(const ModelInput& input, Encode encode)
      : max_radius_(static_cast<int>(number(input.values, "max_radius"))),
        moments_(input, longest_box_side(max_radius_), encode) {}

  /// The half-width in texels of the box in which all blockers are.
  T search(const Receiver& r) const {
    const T widest(std::max(static_cast<P>(max_radius_), kLeastHalfWidth));
    return half_width(r, T(static_cast<P>(r.depth_unbiased)), widest);
  }

  /// That of the box for a blocker so far above the receiver, in depth; no wider than `widest`.
  T half_width(const Receiver& r, const T& above, const T& widest) const {
    return minimum(maximum(PenumbraDisk<T>::widen(r, above, kBoxOfDisk), T(kLeastHalfWidth)), widest);
  }

  /// The radius of the disk with the box's standard deviation.
  static double disk_radius(const T& half_width) { return value_of(half_width) / static_cast<double>(kBoxOfDisk); }

  /// The moments of a box, and, in tracked precision, how much they change where its width is as far off as it may be.
  std::array<T, N> moments(const Receiver& r, const T& half_width, Tally& tally) const {
    const auto around = [&](double reach) { return moments_.around(r, static_cast<P>(reach)); };
    const auto moments = around(value_of(half_width));
    if constexpr (std::is_same_v<T, Tracked>) {
      const double off = std::min(half_width.bound, kUncertain);
      if (half_width.bound > kUncertain) tally.excused = true;
      return widen_bounds(moments, around(half_width.value - off), around(half_width.value + off));
    } else {
      return moments;
    }
  }

 private:
  static constexpr P kLeastHalfWidth = P(0.5);
  static constexpr P kBoxOfDisk = P(0.8660254);
  static constexpr double kUncertain = 0.5;  // texels: a box of a width so far off says nothing

  int max_radius_;
  SummedMoments<T, N> moments_;
};

/// The end of a lookup whose first taps agree: shaders/lib/early_bail.glsl.
class EarlyBail {
 public:
  explicit EarlyBail(const ParamValues& values) : bails_(text_or(values, "bail", "none") == "agree") {}

  /// Puts a disk's points in the order of their taps: with a bail the last first, which are those at the rim of a
  /// spiral.
  void order(std::vector<glm::vec2>& points) const {
    if (bails_) std::ranges::reverse(points);
  }

  /// The mean of what a function makes of ordered points, or of the first where these agree.
  template <class T, class Compare>
  T average(const std::vector<glm::vec2>& points, Tally& tally, Compare compare) const {
    using P = Position<T>;
    T sum{};
    for (std::size_t i = 0; i < points.size(); ++i) {
      sum = sum + compare(points[i]);
      if (agrees(i, value_of(sum), tally)) return T(value_of(sum) > 0.0 ? P(1) : P(0));
    }
    return sum / T(static_cast<P>(points.size()));
  }

  /// Whether the first taps, of which i is the last so far, are all lit or all blocked; excused where a weight that is
  /// as good as none keeps them from it.
  bool agrees(std::size_t i, double sum, Tally& tally) const {
    if (!bails_ || i + 1 != kFirstTaps) return false;
    const double from_end = std::min(sum, static_cast<double>(kFirstTaps) - sum);
    if (from_end != 0.0 && from_end < kRounding) tally.excused = true;
    return from_end == 0.0;
  }

 private:
  static constexpr std::size_t kFirstTaps = 4;
  static constexpr double kRounding = 1e-3;

  bool bails_;
};

}  // namespace shadowbench::filters
