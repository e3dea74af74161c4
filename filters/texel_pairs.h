#pragma once

#include <array>

#include "filters/model.h"

namespace shadowbench::filters {

/// Bounds what the rounding of the receiver's place between texels does to visibility. In units of 2^-24 the place is 8
/// map sizes off. All weights together change by twice the kernel's top per texel that it slides, which is at most 1,
/// and those in the fetches' places by as much again; once for each axis.
inline double bound_pair_placement(int map_size) {
  return 32.0 * kUnitRoundoff * (static_cast<double>(map_size) + 4.0);
}

/// The scalar model of shaders/lib/texel_pairs.glsl: a separable kernel over 2 * kPairs texels per axis, read in pairs
/// by hardware 2x2 fetches. `Weigh` gives the weights of one axis, which sum to 1, from the receiver's place between
/// texels.
template <class T, int kPairs, class Weigh>
class TexelPairs {
 public:
  using P = Position<T>;
  using Weights = std::array<P, static_cast<std::size_t>(2 * kPairs)>;

  explicit TexelPairs(const ModelInput& input) : map_(input) {}

  static Kernel kernel(const ParamValues&) { return Weigh::kernel(); }

  T visibility(const Receiver& r, Tally& tally) const {
    const Axis x = place(r.uv.x), y = place(r.uv.y);
    T sum{};
    for (std::size_t row = 0; row < kPairs; ++row) {
      for (std::size_t column = 0; column < kPairs; ++column) {
        const T share = T(x.both[column]) * T(y.both[row]);
        sum = sum + share * map_.compare_2x2(r, {x.offset[column], y.offset[row]}, r.depth, tally);
      }
    }
    return minimum(sum + make_uncertain<T>(0, bound_pair_placement(map_.grid().size())), T(P(1)));
  }

 private:
  /// The fetches of one axis.
  struct Axis {
    std::array<P, static_cast<std::size_t>(kPairs)> both{};    ///< weights of the two texels together
    std::array<P, static_cast<std::size_t>(kPairs)> offset{};  ///< texels
  };

  DepthReader<T> map_;

  Axis place(float uv) const {
    const P t = map_.grid().fraction(uv);
    const Weights weights = Weigh::template weigh<P>(t);
    Axis axis;
    for (std::size_t i = 0; i < kPairs; ++i) {
      axis.both[i] = weights[2 * i] + weights[2 * i + 1];
      axis.offset[i] = static_cast<P>(static_cast<int>(2 * i) + 1 - kPairs) - t + weights[2 * i + 1] / axis.both[i];
    }
    return axis;
  }
};

/// A triangle of half-width kPairs - 1/2, integrated over every texel.
template <int kPairs>
struct TrianglePairs {
  static constexpr double kHalfWidth = kPairs - 0.5;
  static Kernel kernel() { return Kernel::make_triangle(kHalfWidth); }

  template <class P>
  static std::array<P, static_cast<std::size_t>(2 * kPairs)> weigh(P t) {
    const P h = static_cast<P>(kHalfWidth);
    std::array<P, static_cast<std::size_t>(2 * kPairs)> weights;
    weights.front() = P(0.5) * (P(1) - t) * (P(1) - t) / (h * h);
    weights.back() = P(0.5) * t * t / (h * h);
    for (int i = 1; i < 2 * kPairs - 1; ++i) {
      const P d = std::abs(static_cast<P>(i + 1 - kPairs) - t), fold = std::max(P(0.5) - d, P(0));
      weights[static_cast<std::size_t>(i)] = (h - d - fold * fold) / (h * h);
    }
    return weights;
  }

  template <class T>
  using Filter = TexelPairs<T, kPairs, TrianglePairs>;
};

/// Whole-numbered weights at whole texels, interpolated linearly between two of them.
template <int... kAtTexels>
struct SlidingPairs {
  static constexpr int kSum = (... + kAtTexels), kCount = sizeof...(kAtTexels), kPairs = (kCount + 1) / 2;
  static constexpr std::array<int, static_cast<std::size_t>(kCount)> kWeights{kAtTexels...};

  static Kernel kernel() {
    std::vector<Kernel::Atom> atoms;
    for (int i = 0; i < kCount; ++i)
      atoms.push_back({static_cast<double>(i + 1 - kPairs),
                       static_cast<double>(kWeights[static_cast<std::size_t>(i)]) / static_cast<double>(kSum)});
    return Kernel::make_grid(std::move(atoms), Reconstruction::kBilinear);
  }

  template <class P>
  static std::array<P, static_cast<std::size_t>(2 * kPairs)> weigh(P t) {
    std::array<P, static_cast<std::size_t>(2 * kPairs)> weights{};
    for (std::size_t i = 0; i < kCount; ++i) {
      const P weight = static_cast<P>(kWeights[i]) / static_cast<P>(kSum);
      weights[i] += weight * (P(1) - t);
      weights[i + 1] += weight * t;
    }
    return weights;
  }

  template <class T>
  using Filter = TexelPairs<T, kPairs, SlidingPairs>;
};

/// The scalar model of the mean of four hardware 2x2 fetches, each `kHalfTexels` halves of a texel beside the receiver
/// along both axes.
template <int kHalfTexels>
struct FourTaps {
  template <class T>
  class Filter {
    using P = Position<T>;
    static constexpr double kReach = 0.5 * kHalfTexels;

   public:
    explicit Filter(const ModelInput& input) : map_(input) {}

    static Kernel kernel(const ParamValues&) {
      return Kernel::make_grid({{-kReach, 0.5}, {kReach, 0.5}}, Reconstruction::kBilinear);
    }

    T visibility(const Receiver& r, Tally& tally) const {
      T sum{};
      for (const P y : {P(-kReach), P(kReach)})
        for (const P x : {P(-kReach), P(kReach)}) sum = sum + map_.compare_2x2(r, {x, y}, r.depth, tally);
      return T(P(0.25)) * sum;
    }

   private:
    DepthReader<T> map_;
  };
};

}  // namespace shadowbench::filters
