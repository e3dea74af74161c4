#pragma once

#include <cmath>
#include <type_traits>

#include "filters/tracked.h"

namespace shadowbench::filters {

/// The type that texel positions are computed in. Their rounding is not tracked; it is excused at texel borders.
template <class T>
using Position = std::conditional_t<std::is_same_v<T, float>, float, double>;

template <class T>
T maximum(T a, T b) {
  if constexpr (std::is_same_v<T, Tracked>)
    return max(a, b);
  else
    return a > b ? a : b;
}

template <class T>
T minimum(T a, T b) {
  if constexpr (std::is_same_v<T, Tracked>)
    return min(a, b);
  else
    return a < b ? a : b;
}

template <class T>
T absolute(T a) {
  return maximum(a, -a);
}

/// e^x with the accuracy of the GL at hand.
template <class T>
T exponential(T x, [[maybe_unused]] const GlAccuracy& accuracy) {
  if constexpr (std::is_same_v<T, Tracked>) {
    const double e = std::exp(x.value);
    const double propagated = e * std::expm1(x.bound);
    return Tracked(e, propagated + accuracy.exp_roundoffs * kUnitRoundoff * (e + propagated) + 0x1p-126);
  } else {
    return std::exp(x);
  }
}

/// The sine or cosine, `curve`, of x. GLSL promises nothing of them; Vulkan's absolute error of 2^-11 within a turn is
/// taken (Khronos 2024, Vulkan 1.3, Precision of Instructions).
template <class T, class Curve>
T wave(T x, Curve curve) {
  if constexpr (std::is_same_v<T, Tracked>)
    return Tracked(curve(x.value), x.bound + 0x1p-11);
  else
    return curve(x);
}

/// ln x. GLSL grants 3 ULP, or an absolute error of 2^-21 within [0.5, 2] (Khronos 2023, GLSL 4.60, 4.7.1).
template <class T>
T logarithm(T x) {
  if constexpr (std::is_same_v<T, Tracked>) {
    const double l = std::log(x.value);
    const double smallest = x.value - x.bound;
    if (smallest <= 0.0) return Tracked(l, HUGE_VAL);
    return Tracked(l, x.bound / smallest + std::max(0x1p-21, 6.0 * kUnitRoundoff * std::abs(l)));
  } else {
    return std::log(x);
  }
}

/// Returns the value and, when rounding is tracked, adds `bound` for errors that are not tracked themselves, such as
/// those of positions.
template <class T>
T make_uncertain(Position<T> value, [[maybe_unused]] double bound) {
  if constexpr (std::is_same_v<T, Tracked>)
    return Tracked(value, bound);
  else
    return value;
}

/// Bounds the error of a filtering weight, or of the place that it stands for.
inline double bound_sampler_weight(const GlAccuracy& accuracy, double map_size) {
  // u * size, - 0.5, and the subtraction of the base, each rounded at the map's scale.
  return 3.0 * kUnitRoundoff * map_size + (accuracy.weight_bits < 23.0 ? std::exp2(-accuracy.weight_bits) : 0.0);
}

/// The fraction of a texel position as the filtering weight that the sampler would use.
template <class T>
T sampler_weight(Position<T> position, Position<T> base, const GlAccuracy& accuracy, double map_size) {
  const Position<T> fraction = position - base;
  return make_uncertain<T>(fraction, bound_sampler_weight(accuracy, map_size));
}

}  // namespace shadowbench::filters
