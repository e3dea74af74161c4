#pragma once

#include <algorithm>
#include <cmath>

namespace shadowbench::filters {

/// The unit round-off of IEEE single precision.
inline constexpr double kUnitRoundoff = 0x1p-24;

/// Bounds what elementary functions of the GL at hand may get wrong, as `list gl --measure` finds it.
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

}  // namespace shadowbench::filters
