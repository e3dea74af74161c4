#pragma once

#include "filters/model.h"

namespace shadowbench::filters {

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
