#pragma once

#include <numbers>

#include "filters/encoded_map.h"
#include "filters/model.h"
#include "filters/random.h"

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

inline constexpr double kSafety = 2.0;

/// What a function makes of moments, and by how much more than that their roundings may change it.
template <class T, class Function>
T track(const std::array<T, 4>& stored, float bias, const Function& function) {
  const auto seen = function(values_of(stored));
  if constexpr (std::is_same_v<T, Tracked>)
    return {seen, kSafety * change_by_rounding(stored, static_cast<double>(bias), seen, function)};
  else
    return seen;
}

/// The map of a filter that blurs four moments.
template <class T>
EncodedMap<T, 4> make_map(const ModelInput& input) {
  return EncodedMap<T, 4>(
      input, static_cast<int>(number(input.values, "radius")), [](const EncodeInput<T>& e) { return encode(e.depth); });
}

}  // namespace four_moments

/// The scalar model of moment shadow maps.
template <Depths kDepths>
struct FourMoments {
  template <class T>
  class Filter {
    using P = Position<T>;

   public:
    explicit Filter(const ModelInput& input) : map_(four_moments::make_map<T>(input)), bias_(fit_bias(input.values)) {}

    static Kernel kernel(const ParamValues& values) { return EncodedMap<T, 4>::kernel(values); }

    T visibility(const Receiver& r, Tally& tally) const {
      if constexpr (std::is_same_v<T, Tracked>)
        return bound(r, tally);
      else
        return four_moments::find_light(kDepths, map_.fetch(r, tally), T(r.depth), T(bias_));
    }

   private:
    using Stored = std::array<double, 4>;

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
      T seen =
          four_moments::track(map_.fetch_between(r, {}), bias_, [&](const Stored& moved) { return light(moved, r); });
      seen.bound += four_moments::kSafety * change_by_place(r, seen.value);
      return seen;
    }
  };
};

// The same as the functions of shaders/lib/packed_moments.glsl, which cites their sources. S is a floating-point type.
namespace packed_moments {

/// How many values each of the four numbers can take: the nearer depth, the farther one, share and spread.
using Levels = std::array<int, 4>;

/// Depths within [-1,1], the share of the farther one, and the part of `kEvenSpread` and the rest that the rest is.
template <class S>
struct Packed {
  S nearer, farther, share, spread;
};

template <class S>
inline const S kEvenSpread = S(0.05f);

template <class S>
inline const S kLeastShare = S(2e-4f);

template <class S>
inline const S kLeastSpread = S(1e-6f);

/// The unrounded numbers.
template <class S>
Packed<S> describe(const four_moments::Moments<S>& b) {
  const S variance = b[1] - b[0] * b[0], tilt = b[2] - b[0] * b[1], middle = S(0.5) * tilt / variance;
  const S reach = std::sqrt((middle - b[0]) * (middle - b[0]) + variance);
  const S nearer = middle - reach, farther = middle + reach;
  const S rest = std::max(b[3] - b[1] * b[1] - S(2) * middle * tilt, S(0));
  const S spread = rest / (rest + kEvenSpread<S> * (S(16) * reach * reach * reach * reach));
  return {nearer, farther, (b[0] - nearer) / (farther - nearer), spread};
}

/// What comes back of them from a texel.
template <class S>
Packed<S> pack(const four_moments::Moments<S>& b, const Levels& levels) {
  Packed<S> p = describe(b);
  const S last_near = static_cast<S>(levels[0] - 1), last_far = static_cast<S>(levels[1] - 1);
  const auto step = [](S depth, S last) { return std::floor((S(0.5) + S(0.5) * depth) * last + S(0.5)); };
  const S near_step = std::clamp(step(p.nearer, last_near), S(0), last_near - S(1));
  const S far_step = std::clamp(step(p.farther, last_far), near_step + S(1), last_far);
  p.nearer = S(2) * near_step / last_near - S(1);
  p.farther = S(2) * far_step / last_far - S(1);
  p.share = std::clamp((b[0] - p.nearer) / (p.farther - p.nearer), S(0), S(1));
  const S last_share = static_cast<S>(levels[2] - 1), last_spread = static_cast<S>(levels[3] - 1);
  p.share = std::floor(p.share * last_share + S(0.5)) / last_share;
  const S root = std::ceil(std::sqrt(p.spread) * last_spread) / last_spread;
  p.spread = root * root;
  return p;
}

/// `margin` is taken off x, as what rounding may have moved a surface by.
template <class S>
S find_share(const Packed<S>& p, S x, S margin) {
  const S place = (x - margin - p.nearer) / (p.farther - p.nearer);
  const S share = std::clamp(p.share, kLeastShare<S>, S(1) - kLeastShare<S>);
  const S spread = std::clamp(p.spread, kLeastSpread<S>, S(1) - kLeastSpread<S>);
  const S rest = kEvenSpread<S> * spread / (S(1) - spread);
  const S square = place * (place - S(1)) / rest, least = (S(1) - place) / (S(1) - share);
  return four_moments::share_of_points({share}, place, {least, place / share - least - square, square});
}

}  // namespace packed_moments

/// The scalar model of moment shadow maps whose texels are packed. Numbers are rounded in single precision alone:
/// tracked precision knows by how much that moves the light.
template <packed_moments::Levels kLevels>
struct PackedMoments {
  template <class T>
  class Filter {
    using P = Position<T>;

   public:
    explicit Filter(const ModelInput& input)
        : map_(four_moments::make_map<T>(input)),
          grid_(input.map.size, Border::kEdge, store_bytes(input.spec.passes.back().store)),
          bias_(static_cast<float>(number(input.values, "moment_bias"))),
          mean_of_four_(text_or(input.values, "lookup", "") == "bilinear"),
          seed_(input.seed) {}

    static Kernel kernel(const ParamValues& values) { return EncodedMap<T, 4>::kernel(values); }

    T visibility(const Receiver& r, Tally& tally) const {
      if (r.uv != glm::clamp(r.uv, 0.0f, 1.0f)) return T(P(r.depth <= 1.0f ? 1 : 0));
      const P x = grid_.position(r.uv.x, P(0)) - P(0.5), y = grid_.position(r.uv.y, P(0)) - P(0.5);
      const glm::ivec2 texel(grid_.nearest(x, tally), grid_.nearest(y, tally));
      const P right = x - std::floor(x), up = y - std::floor(y);
      if (!mean_of_four_) return light(texel + choose(r, right, up, tally), r, tally);
      const T low = mix(light(texel, r, tally), light(texel + glm::ivec2(1, 0), r, tally), weight(right));
      const T high = mix(light(texel + glm::ivec2(0, 1), r, tally), light(texel + 1, r, tally), weight(right));
      return mix(low, high, weight(up));
    }

   private:
    using Stored = std::array<double, 4>;
    static constexpr double kSafety = 4.0;   // of the largest difference found: up to 2.8 times it was seen
    static constexpr double kSeen = 0.0625;  // of the moments' bounds: roundings were never seen to reach further
    static constexpr double kTie = 1e-3;     // of light: what a step that rounding decides about may change

    EncodedMap<T, 4> map_;
    TexelGrid<T> grid_;
    float bias_;
    bool mean_of_four_;
    std::uint32_t seed_;

    T weight(P part) const { return make_uncertain<T>(part, 0.5 * grid_.border_tolerance()); }

    /// The texel of the four that blue noise chooses.
    glm::ivec2 choose(const Receiver& r, P right, P up, Tally& tally) const {
      const P tolerance = static_cast<P>(0.5 * grid_.border_tolerance());
      P turn = static_cast<P>(blue_noise_turn(r.pixel, seed_, r.frame));
      const bool goes_right = turn < right;
      const P taken = goes_right ? right : P(1) - right;
      if (std::abs(turn - right) <= tolerance) tally.excused = true;
      turn = (goes_right ? turn : turn - right) / taken;
      if (std::abs(turn - up) * taken <= P(2) * tolerance) tally.excused = true;
      return {goes_right ? 1 : 0, turn < up ? 1 : 0};
    }

    /// The receiver's depth, biased for a texel by its distance.
    P depth_at(const glm::ivec2& texel, const Receiver& r) const {
      const P x = std::abs(static_cast<P>(texel.x) + P(0.5) - grid_.position(r.uv.x, P(0)));
      const P y = std::abs(static_cast<P>(texel.y) + P(0.5) - grid_.position(r.uv.y, P(0)));
      return static_cast<P>(r.depth) -
             (static_cast<P>(r.bias_per_texel.x) * x + static_cast<P>(r.bias_per_texel.y) * y);
    }

    T light(const glm::ivec2& texel, const Receiver& r, Tally& tally) const {
      grid_.read(texel.x, texel.y);
      const glm::ivec2 inside = glm::clamp(texel, 0, grid_.size() - 1);
      const auto& stored = map_.texel(inside.x, inside.y);
      const P depth = depth_at(texel, r);
      if constexpr (std::is_same_v<T, Tracked>) {
        const double slope = static_cast<double>(std::abs(r.bias_per_texel.x) + std::abs(r.bias_per_texel.y));
        return bound(stored, {depth, grid_.border_tolerance() * slope + 2.0 * kUnitRoundoff}, tally);
      } else {
        const auto moments = four_moments::decode(stored, T(bias_));
        const bool rounds = std::is_same_v<T, float>;
        return light_of(rounds ? packed_moments::pack(moments, kLevels) : packed_moments::describe(moments), T(depth));
      }
    }

    template <class S>
    S light_of(const packed_moments::Packed<S>& p, S depth) const {
      const S margin = S(1.25) / static_cast<S>(kLevels[0] - 1), bias = S(bias_) + packed_moments::kLeastShare<S>;
      const S share = packed_moments::find_share(p, S(2) * depth - S(1), margin);
      return S(1) - four_moments::unbias_share(share, bias);
    }

    struct Light {
      double packed, exact;
      double step() const { return packed - exact; }
    };

    /// The light of moments that are packed, and of the same that are not.
    Light both(const four_moments::Moments<double>& moments, double depth) const {
      return {light_of(packed_moments::pack(moments, kLevels), depth),
              light_of(packed_moments::describe(moments), depth)};
    }

    /// How far the light of the packed moments is from that of the moments, where these and the depth are off by a
    /// quarter and by half of their bounds, all ways round: the largest difference times kSafety. Where small parts of
    /// the bounds decide to which step a number is rounded, and that is seen, it excuses.
    T bound(const std::array<T, 4>& texel, const Tracked& depth, Tally& tally) const {
      const double bias = static_cast<double>(bias_);
      const Stored stored = four_moments::values_of(texel);
      const Light here = both(four_moments::decode(stored, bias), depth.value);
      double largest = std::abs(here.step());
      for (const double part : {kSeen, 0.25, 0.5}) {
        for (unsigned corner = 0; corner < 32; ++corner) {
          const auto off = [&](std::size_t i, double bound) {
            return (corner >> i & 1u) != 0 ? part * bound : -part * bound;
          };
          Stored moved = stored;
          for (std::size_t i = 0; i < 4; ++i) moved[i] += off(i, bound_of(texel[i]) + four_moments::kEvaluation);
          const auto moments = four_moments::decode(moved, bias);
          if (!four_moments::are_of_a_distribution(moments)) return {here.exact, HUGE_VAL};
          const Light there = both(moments, depth.value + off(4, depth.bound));
          if (part == kSeen && std::abs(there.step() - here.step()) > kTie) tally.excused = true;
          largest = std::max(largest, std::abs(there.packed - here.exact));
        }
      }
      return {here.exact, kSafety * largest};
    }
  };
};

}  // namespace shadowbench::filters
