#pragma once

#include <numbers>

#include "filters/encoded_map.h"
#include "filters/model.h"

namespace shadowbench::filters {

/// Which depths the distributions may hold that a moment shadow map is consistent with.
enum class Depths { kAny, kInRange };

// The same as the functions of shaders/lib/four_moments.glsl, which cites their sources. S is a floating-point type.
namespace four_moments {

template <class S>
using Moments = std::array<S, 4>;  ///< E[x] .. E[x^4], x in [-1,1]

template <class S>
inline const S kRoot3 = std::numbers::sqrt3_v<S>;

template <class T, class P = Position<T>>
std::array<T, 4> encode(T depth) {
  const T x = T(P(2)) * depth - T(P(1)), square = x * x, half(P(0.5));
  return {x * (T(P(1.5)) - T(P(2)) * square) + half, T(P(4)) * square * (T(P(1)) - square),
          T(kRoot3<P>) * x * (half - square * T(P(2)) / T(P(9))) + half, half * square * (T(P(1)) + square)};
}

template <class S>
Moments<S> decode(const std::array<S, 4>& stored, S bias) {
  const S first = stored[0] - S(0.5), third = kRoot3<S> * (stored[2] - S(0.5));
  Moments<S> b{third - first / S(3), stored[3] + S(0.125) * stored[1], S(0.75) * (third - first),
               stored[3] - S(0.125) * stored[1]};
  for (std::size_t i = 0; i < 4; ++i) b[i] = b[i] * (S(1) - bias) + (i % 2 == 1 ? S(0.375) * bias : S(0));
  return b;
}

template <class S>
std::array<S, 3> solve(const Moments<S>& b, S x) {
  const S variance = b[1] - b[0] * b[0], skew = (b[2] - b[0] * b[1]) / variance;
  const S rest = b[3] - b[1] * b[1] - skew * (b[2] - b[0] * b[1]);
  const S c2 = (x * x - b[1] - skew * (x - b[0])) / rest, c1 = (x - b[0]) / variance - skew * c2;
  return {S(1) - c1 * b[0] - c2 * b[1], c1, c2};
}

/// Whether numbers are the moments of some distribution.
template <class S>
bool are_of_a_distribution(const Moments<S>& b) {
  const S variance = b[1] - b[0] * b[0], skew = b[2] - b[0] * b[1];
  return variance > S(0) && variance * (b[3] - b[1] * b[1]) > skew * skew;
}

template <class S>
S share_of_points(const Moments<S>& b, S x, const std::array<S, 3>& c) {
  const S mass = S(1) / (c[0] + x * (c[1] + x * c[2]));
  if (c[2] >= S(0)) return c[1] + S(2) * c[2] * x < S(0) ? S(0) : S(1) - mass;
  const S root = std::sqrt(c[1] * c[1] - S(4) * c[0] * c[2]);
  return (S(0.5) * (S(1) - mass) * (c[1] + root) + c[2] * (b[0] - mass * x)) / root;
}

template <class S>
S distance_to_blockers(const Moments<S>& b, S x, const std::array<S, 3>& c) {
  const S mass = S(1) / (c[0] + x * (c[1] + x * c[2]));
  if (c[2] >= S(0)) return (x - b[0]) / (S(1) - mass);
  const S root = std::sqrt(c[1] * c[1] - S(4) * c[0] * c[2]);
  return x - (c[1] < S(0) ? S(0.5) * (root - c[1]) / c[2] : S(-2) * c[0] / (c[1] + root));
}

template <class S>
bool leaves_range(const std::array<S, 3>& c) {
  const S root = std::sqrt(std::max(c[1] * c[1] - S(4) * c[0] * c[2], S(0)));
  const S far = S(-0.5) * (c[1] + (c[1] < S(0) ? -root : root));
  const S one = far / c[2], other = c[0] / far;
  return std::min(one, other) < S(-1) || std::max(one, other) > S(1);
}

template <class S>
S share_with_ends(const Moments<S>& b, S x) {
  const S free = ((b[1] - b[3]) - x * (b[0] - b[2])) / ((b[0] - b[2]) - x * (S(1) - b[1]));
  const S sum = x + free, product = x * free;
  if (free >= x)
    return (b[2] - b[1] * (sum + S(1)) + b[0] * (product + sum) - product) / (S(-2) * (S(1) + x) * (S(1) + free));
  const S at_x = (b[2] - b[0] - free * (b[1] - S(1))) / ((x * x - S(1)) * (x - free));
  const S at_far =
      (b[2] - b[1] * (sum - S(1)) + b[0] * (product - sum) + product) / (S(2) * (S(1) - x) * (S(1) - free));
  return S(1) - at_x - at_far;
}

template <class S>
S find_share(Depths depths, const Moments<S>& b, S x) {
  if (depths == Depths::kAny) return share_of_points(b, x, solve(b, x));
  if (x <= S(-1)) return S(0);
  if (x > S(1)) return S(1);
  x = std::min(x, S(0.9999f));
  const std::array<S, 3> c = solve(b, x);
  return leaves_range(c) ? share_with_ends(b, x) : share_of_points(b, x, c);
}

template <class S>
S unbias_share(S share, S bias) {
  return std::clamp((share - bias) / (S(1) - bias), S(0), S(1));
}

template <class S>
S find_light(Depths depths, const std::array<S, 4>& stored, S depth, S bias) {
  const S share = find_share(depths, decode(stored, bias), S(2) * depth - S(1));
  return S(1) - unbias_share(share, bias);
}

/// The values of moments, without what tracks their rounding.
inline std::array<double, 4> values_of(const std::array<Tracked, 4>& stored) {
  return {stored[0].value, stored[1].value, stored[2].value, stored[3].value};
}
template <class S>
std::array<S, 4> values_of(const std::array<S, 4>& stored) {
  return stored;
}

inline constexpr double kEvaluation = 16.0 * kUnitRoundoff;  // of a lookup, as an error of the moments

/// How far what `function` makes of stored moments is from `seen`, where these are off by a quarter and by half of
/// their bounds, all ways round: the largest difference. Moments that belong to no distribution may become anything.
template <class Function>
double change_by_rounding(const std::array<Tracked, 4>& stored, double bias, double seen, const Function& function) {
  double largest = 0.0;
  for (const double part : {0.25, 0.5}) {
    for (unsigned corner = 0; corner < 16; ++corner) {
      std::array<double, 4> moved{};
      for (std::size_t i = 0; i < 4; ++i) {
        const double off = part * (stored[i].bound + kEvaluation);
        moved[i] = stored[i].value + ((corner >> i & 1u) != 0 ? off : -off);
      }
      if (!are_of_a_distribution(decode(moved, bias))) return HUGE_VAL;
      largest = std::max(largest, std::abs(function(moved) - seen));
    }
  }
  return largest;
}

}  // namespace four_moments

/// The scalar model of moment shadow maps.
template <Depths kDepths>
struct FourMoments {
  template <class T>
  class Filter {
    using P = Position<T>;

   public:
    explicit Filter(const ModelInput& input)
        : map_(input, static_cast<int>(number(input.values, "radius")),
               [](const EncodeInput<T>& e) { return four_moments::encode(e.depth); }),
          bias_(fit_bias(input.values)) {}

    static Kernel kernel(const ParamValues& values) { return EncodedMap<T, 4>::kernel(values); }

    T visibility(const Receiver& r, Tally& tally) const {
      if constexpr (std::is_same_v<T, Tracked>)
        return bound(r, tally);
      else
        return four_moments::find_light(kDepths, map_.fetch(r, tally), T(r.depth), T(bias_));
    }

   private:
    using Stored = std::array<double, 4>;
    static constexpr double kSafety = 2.0;

    EncodedMap<T, 4> map_;
    float bias_;

    static float fit_bias(const ParamValues& values) {
      const bool is_unorm = store_precision(text_or(values, "store", "")) == StorePrecision::kUnorm16;
      return std::max(static_cast<float>(number(values, "moment_bias")), is_unorm ? 1.2e-4f : 0.0f);
    }

    double light(const Stored& stored, const Receiver& r) const {
      return four_moments::find_light(kDepths, stored, static_cast<double>(r.depth), static_cast<double>(bias_));
    }

    /// How much the light changes from what is seen where the place in the map is off.
    double change_by_place(const Receiver& r, double seen) const {
      const double step = map_.placement();
      double largest = 0.0;
      for (const Offset<T>& shift : {Offset<T>{step, step}, {step, -step}, {-step, step}, {-step, -step}})
        largest = std::max(largest, std::abs(light(four_moments::values_of(map_.fetch_between(r, shift)), r) - seen));
      return largest;
    }

    /// A bound that is carried through the solution of the moments would say nothing: their errors cancel there. So the
    /// changes are computed instead, added, and doubled. Bounds add up the worst of every rounding, which come near to
    /// half of it in no map that was looked at.
    T bound(const Receiver& r, Tally& tally) const {
      map_.fetch(r, tally);
      const auto middle = map_.fetch_between(r, {});
      const double seen = light(four_moments::values_of(middle), r);
      const double by_rounding = four_moments::change_by_rounding(middle, static_cast<double>(bias_), seen,
                                                                  [&](const Stored& moved) { return light(moved, r); });
      return {seen, kSafety * (by_rounding + change_by_place(r, seen))};
    }
  };
};

}  // namespace shadowbench::filters
