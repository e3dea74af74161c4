#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <type_traits>

namespace shadowbench::filters {

/// The unit round-off of IEEE single precision.
inline constexpr double kUnitRoundoff = 0x1p-24;

/// Bounds what elementary functions of the GL at hand may get wrong, as a survey of it finds.
struct GlAccuracy {
  double exp_roundoffs = 8.0;  ///< relative error of exp(), in units of 2^-24
  double weight_bits = 23.0;   ///< fraction bits of linear filtering weights; 23 or more: full single precision
};

/// A real number together with a bound on how far the same computation in single precision can be from it: running
/// error analysis. Source: Higham 2002, Accuracy and Stability of Numerical Algorithms, 2nd ed., section 3.3.
struct Tracked {
  double value = 0.0;
  double bound = 0.0;  ///< |single precision result - value| is at most this

  Tracked() = default;
  /// An input that single precision holds exactly.
  Tracked(double v) : value(v) {}  // NOLINT: numbers mix with literals in the models
  Tracked(double v, double b) : value(v), bound(b) {}

  /// Adds the rounding of one operation; fused multiply-adds round less often, so the bound holds for them too.
  static Tracked rounded(double v, double propagated) {
    return {v, propagated + kUnitRoundoff * (std::abs(v) + propagated) + 0x1p-126};
  }
};

inline Tracked operator+(Tracked a, Tracked b) { return Tracked::rounded(a.value + b.value, a.bound + b.bound); }
inline Tracked operator-(Tracked a, Tracked b) { return Tracked::rounded(a.value - b.value, a.bound + b.bound); }
inline Tracked operator-(Tracked a) { return {-a.value, a.bound}; }
inline Tracked operator*(Tracked a, Tracked b) {
  return Tracked::rounded(a.value * b.value,
                          std::abs(a.value) * b.bound + std::abs(b.value) * a.bound + a.bound * b.bound);
}
/// GLSL grants division 2.5 ULP (Khronos 2023, GLSL 4.60, section 4.7.1): five roundings instead of one.
inline Tracked operator/(Tracked a, Tracked b) {
  const double quotient = a.value / b.value;
  const double smallest = std::abs(b.value) - b.bound;
  if (smallest <= 0.0) return {quotient, HUGE_VAL};
  const double propagated = (a.bound + std::abs(quotient) * b.bound) / smallest;
  return {quotient, propagated + 5.0 * kUnitRoundoff * (std::abs(quotient) + propagated) + 0x1p-126};
}

// Minimum and maximum are 1-Lipschitz, so no branch of the single precision run can escape the bound.
inline Tracked max(Tracked a, Tracked b) { return {std::max(a.value, b.value), std::max(a.bound, b.bound)}; }
inline Tracked min(Tracked a, Tracked b) { return {std::min(a.value, b.value), std::max(a.bound, b.bound)}; }

/// Adds to the bounds of what was found by how far off it is at both ends of what it may have been found for.
template <std::size_t N>
std::array<Tracked, N> widen_bounds(std::array<Tracked, N> found, const std::array<Tracked, N>& low,
                                    const std::array<Tracked, N>& high) {
  for (std::size_t i = 0; i < N; ++i)
    found[i].bound += std::max(std::abs(low[i].value - found[i].value), std::abs(high[i].value - found[i].value));
  return found;
}

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

/// What lies at a share of the way from one number to another.
template <class T>
T mix(T a, T b, T share) {
  return a + share * (b - a);
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

/// Bounds the error of a filtering weight, or of the place that it stands for. Hardware rounds products of weights,
/// too: on an NVIDIA H200, of 8 bits, `esm` was off by up to 1.85 times its bound where that took 2^-8 for a weight's
/// error.
inline double bound_sampler_weight(const GlAccuracy& accuracy, double map_size) {
  // u * size, - 0.5, and the subtraction of the base, each rounded at the map's scale.
  return 3.0 * kUnitRoundoff * map_size + (accuracy.weight_bits < 23.0 ? std::exp2(1.0 - accuracy.weight_bits) : 0.0);
}

/// The fraction of a texel position as the filtering weight that the sampler would use.
template <class T>
T sampler_weight(Position<T> position, Position<T> base, const GlAccuracy& accuracy, double map_size) {
  const Position<T> fraction = position - base;
  return make_uncertain<T>(fraction, bound_sampler_weight(accuracy, map_size));
}

}  // namespace shadowbench::filters
