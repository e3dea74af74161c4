#pragma once

#include "filters/encoded_map.h"
#include "filters/model.h"

namespace shadowbench::filters {

/// The scalar model of exponential variance shadow maps with one warp or two; the same as
/// shaders/lib/warped_variance.glsl. Without a fit, as a teaching filter has it, the exponent may overflow the store.
template <int kWarps, bool kIsFit = true>
struct WarpedVariance {
  template <class T>
  class Filter {
    using P = Position<T>;
    static constexpr std::size_t kChannels = 2 * kWarps;

   public:
    explicit Filter(const ModelInput& input)
        : accuracy_(input.accuracy),
          c_(fit_exponent(input.values, "c")),
          c_down_(kWarps == 2 ? fit_exponent(input.values, "c_down") : P(0)),
          map_(input, static_cast<int>(number(input.values, "radius")),
               [this](const EncodeInput<T>& e) { return encode(e.depth); }),
          min_deviation_(read(input.values, "min_deviation")),
          reduction_(kIsFit ? read(input.values, "bleed_reduction") : P(0)) {}

    static Kernel kernel(const ParamValues& values) { return EncodedMap<T, kChannels>::kernel(values); }

    T visibility(const Receiver& r, Tally& tally) const {
      const auto moments = map_.fetch(r, tally);
      const T depth(static_cast<P>(r.depth));
      T light = bound_light(moments[0], moments[1], warp_up(depth), c_);
      if constexpr (kWarps == 2) light = minimum(light, bound_light(moments[2], moments[3], warp_down(depth), c_down_));
      return maximum(light - T(reduction_), T(P(0))) / (T(P(1)) - T(reduction_));
    }

   private:
    GlAccuracy accuracy_;
    P c_;
    P c_down_;
    EncodedMap<T, kChannels> map_;
    P min_deviation_;
    P reduction_;

    static P read(const ParamValues& values, const std::string& name) {
      return static_cast<P>(static_cast<float>(number(values, name)));
    }

    static P fit_exponent(const ParamValues& values, const std::string& name) {
      if (!kIsFit) return read(values, name);
      const double largest = largest_number(store_precision(text_or(values, "store", "")));
      return std::min(read(values, name), static_cast<P>(largest < 1e5 ? 5.54f : 42.0f));
    }

    static T place(T depth) { return T(P(2)) * depth - T(P(1)); }
    T warp_up(T depth) const { return exponential(minimum(T(c_) * place(depth), T(P(80))), accuracy_); }
    T warp_down(T depth) const { return -exponential(minimum(-(T(c_down_) * place(depth)), T(P(80))), accuracy_); }

    std::array<T, kChannels> encode(const T& depth) const {
      const T up = warp_up(depth);
      if constexpr (kWarps == 1) {
        return {up, up * up};
      } else {
        const T down = warp_down(depth);
        return {up, up * up, down, down * down};
      }
    }

    T bound_light(T first, T second, T warped, P c) const {
      // Light does not depend on the unit, so the unit's error is none.
      const T zero(P(0)), one(P(1)), unit(static_cast<P>(1.0 / value_of(maximum(absolute(warped), absolute(first)))));
      const T mean = first * unit, distance = maximum(warped * unit - mean, zero);
      const T least = T(P(2) * c * min_deviation_) * warped * unit;
      const T variance = maximum(second * unit * unit - mean * mean, least * least);
      if (!(value_of(variance) > 0.0)) return value_of(distance) > 0.0 ? zero : one;
      return one / (one + distance * distance / variance);  // one variance: see vsm.cpp
    }
  };
};

}  // namespace shadowbench::filters
