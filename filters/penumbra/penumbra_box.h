#pragma once

#include "filters/penumbra/penumbra_disk.h"
#include "filters/summed_area.h"

namespace shadowbench::filters {

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

}  // namespace shadowbench::filters
