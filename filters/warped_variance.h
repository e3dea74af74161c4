#pragma once

#include "filters/encoded_map.h"
#include "filters/model.h"

namespace shadowbench::filters {

/// Exponential warps of depth, and the light that two moments of one allow: shaders/lib/warped_variance.glsl.
template <class T>
class Warps {
  using P = Position<T>;

 public:
  Warps(const ModelInput& input, P c, P c_down)
      : accuracy_(input.accuracy), c_(c), c_down_(c_down), min_deviation_(read(input.values, "min_deviation")) {}

  static P read(const ParamValues& values, const std::string& name) {
    return static_cast<P>(static_cast<float>(number(values, name)));
  }

  T up(const T& depth) const { return exponential(minimum(T(c_) * place(depth), T(P(80))), accuracy_); }
  T down(const T& depth) const { return -exponential(minimum(-(T(c_down_) * place(depth)), T(P(80))), accuracy_); }

  std::array<T, 4> encode(const T& depth) const {
    const T u = up(depth), d = down(depth);
    return {u, u * u, d, d * d};
  }

  /// The light that both warps allow. Light is not negative, so that the tighter bound speaks for both.
  T bound_light(const std::array<T, 4>& moments, const T& depth) const {
    const T above = bound_light(std::array{moments[0], moments[1]}, depth),
            below = bound(moments[2], moments[3], down(depth), c_down_);
    T light = minimum(above, below);
    if constexpr (std::is_same_v<T, Tracked>)
      light.bound = std::min(light.bound, std::min({above.value + above.bound, below.value + below.bound, 1.0}));
    return light;
  }

  /// The same of the positive warp alone.
  T bound_light(const std::array<T, 2>& moments, const T& depth) const {
    return bound(moments[0], moments[1], up(depth), c_);
  }

  /// The mean depth of blockers, where the share `lit` of the depths around is the receiver's `depth`, and `mean` the
  /// mean of the negative warp of all.
  T depth_of_blockers(const T& depth, const T& mean, const T& lit) const {
    const T own = down(depth), blockers = own - (own - mean) / (T(P(1)) - lit);
    const T warped = minimum(maximum(-blockers, -own), exponential(T(c_down_), accuracy_));
    return T(P(0.5)) - T(P(0.5)) * logarithm(warped) / T(c_down_);
  }

 private:
  GlAccuracy accuracy_;
  P c_;
  P c_down_;
  P min_deviation_;

  static T place(T depth) { return T(P(2)) * depth - T(P(1)); }

  T bound(T first, T second, T warped, P c) const {
    // Light does not depend on the unit, so the unit's error is none.
    const T zero(P(0)), one(P(1)), unit(static_cast<P>(1.0 / value_of(maximum(absolute(warped), absolute(first)))));
    const T mean = first * unit, behind = warped * unit - mean, distance = maximum(behind, zero);
    if (value_of(behind) + bound_of(behind) <= 0.0) return one;
    const T least = T(P(2) * c * min_deviation_) * warped * unit;
    const T variance = maximum(second * unit * unit - mean * mean, least * least);
    if (!(value_of(variance) > 0.0)) return value_of(distance) > 0.0 ? zero : one;
    return one / (one + distance * distance / variance);  // one variance: see vsm.cpp
  }
};

/// The scalar model of exponential variance shadow maps with one warp or two. Without a fit, as a teaching filter has
/// it, the exponent may overflow the store.
template <int kWarps, bool kIsFit = true>
struct WarpedVariance {
  template <class T>
  class Filter {
    using P = Position<T>;
    static constexpr std::size_t kChannels = 2 * kWarps;

   public:
    explicit Filter(const ModelInput& input)
        : warps_(input, fit_exponent(input.values, "c"), kWarps == 2 ? fit_exponent(input.values, "c_down") : P(0)),
          map_(input, static_cast<int>(number(input.values, "radius")),
               [this](const EncodeInput<T>& e) { return encode(e.depth); }),
          reduction_(kIsFit ? Warps<T>::read(input.values, "bleed_reduction") : P(0)) {}

    static Kernel kernel(const ParamValues& values) { return EncodedMap<T, kChannels>::kernel(values); }

    T visibility(const Receiver& r, Tally& tally) const {
      const T light = warps_.bound_light(map_.fetch(r, tally), T(static_cast<P>(r.depth)));
      return maximum(light - T(reduction_), T(P(0))) / (T(P(1)) - T(reduction_));
    }

   private:
    Warps<T> warps_;
    EncodedMap<T, kChannels> map_;
    P reduction_;

    static P fit_exponent(const ParamValues& values, const std::string& name) {
      const P c = Warps<T>::read(values, name);
      if (!kIsFit) return c;
      const double largest = largest_number(store_precision(text_or(values, "store", "")));
      return std::min(c, static_cast<P>(largest < 1e5 ? 5.54f : 42.0f));
    }

    std::array<T, kChannels> encode(const T& depth) const {
      if constexpr (kWarps == 2) {
        return warps_.encode(depth);
      } else {
        const T up = warps_.up(depth);
        return {up, up * up};
      }
    }
  };
};

}  // namespace shadowbench::filters
