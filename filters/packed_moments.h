#pragma once

#include "filters/four_moments.h"
#include "filters/random.h"

namespace shadowbench::filters {

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
        : map_(input, static_cast<int>(number(input.values, "radius")),
               [](const EncodeInput<T>& e) { return four_moments::encode(e.depth); }),
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
