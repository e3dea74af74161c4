#include "filters/encoded_map.h"
#include "filters/model.h"

namespace shadowbench::filters {
namespace {

template <class T>
class Vsm {
  using P = Position<T>;

 public:
  explicit Vsm(const ModelInput& input)
      : slope_variance_(static_cast<P>(static_cast<float>(number(input.values, "slope_variance")))),
        map_(input, static_cast<int>(number(input.values, "radius")),
             [this](const EncodeInput<T>& e) { return encode(e); }),
        min_variance_(static_cast<P>(static_cast<float>(number(input.values, "min_variance")))),
        reduction_(static_cast<P>(static_cast<float>(number(input.values, "bleed_reduction")))) {}

  static Kernel kernel(const ParamValues& values) { return EncodedMap<T, 2>::kernel(values); }

  T visibility(const Receiver& r, Tally& tally) const {
    const T zero(P(0)), one(P(1));
    const auto moments = map_.fetch(r, tally);
    const T distance = maximum(T(static_cast<P>(r.depth)) - moments[0], zero);
    const T variance = maximum(moments[1] - moments[0] * moments[0], T(min_variance_));
    const T bound = value_of(variance) > 0.0 ? chebyshev(variance, distance) : value_of(distance) > 0.0 ? zero : one;
    return maximum(bound - T(reduction_), zero) / (one - T(reduction_));
  }

 private:
  P slope_variance_;
  EncodedMap<T, 2> map_;
  P min_variance_;
  P reduction_;

  /// The GLSL's v / (v + d^2), written with one v: a propagated bound would count the error of the other one again.
  static T chebyshev(T variance, T distance) {
    const T one(P(1));
    return one / (one + distance * distance / variance);
  }

  std::array<T, 2> encode(const EncodeInput<T>& e) const {
    const T squared = e.slope[0] * e.slope[0] + e.slope[1] * e.slope[1];
    return {e.depth, e.depth * e.depth + T(slope_variance_) * squared};
  }
};

}  // namespace

std::unique_ptr<Model> make_vsm_model() { return make_templated_model<Vsm>(); }

}  // namespace shadowbench::filters
