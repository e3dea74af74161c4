#pragma once

#include "filters/encoded_map.h"
#include "filters/model.h"

namespace shadowbench::filters {

/// What variance shadow maps store, and the light that two moments allow: the same as the functions of
/// filters/vsm.glsl.
template <class T>
class Variance {
  using P = Position<T>;

 public:
  explicit Variance(const ModelInput& input)
      : slope_variance_(read(input, "slope_variance")),
        min_variance_(read(input, "min_variance")),
        reduction_(read(input, "bleed_reduction")) {}

  std::array<T, 2> encode(const EncodeInput<T>& e) const {
    const T squared = e.slope[0] * e.slope[0] + e.slope[1] * e.slope[1];
    return {e.depth, e.depth * e.depth + T(slope_variance_) * squared};
  }

  T variance(const std::array<T, 2>& moments) const {
    return maximum(moments[1] - moments[0] * moments[0], T(min_variance_));
  }

  T visibility(const std::array<T, 2>& moments, float depth) const {
    const T zero(P(0)), one(P(1));
    const T distance = maximum(T(static_cast<P>(depth)) - moments[0], zero);
    const T variance = this->variance(moments);
    const T bound = value_of(variance) > 0.0 ? chebyshev(variance, distance) : value_of(distance) > 0.0 ? zero : one;
    return maximum(bound - T(reduction_), zero) / (one - T(reduction_));
  }

 private:
  P slope_variance_;
  P min_variance_;
  P reduction_;

  static P read(const ModelInput& input, const char* name) {
    return static_cast<P>(static_cast<float>(number(input.values, name)));
  }

  /// The GLSL's v / (v + d^2), written with one v: a propagated bound would count the error of the other one again.
  static T chebyshev(T variance, T distance) {
    const T one(P(1));
    return one / (one + distance * distance / variance);
  }
};

}  // namespace shadowbench::filters
