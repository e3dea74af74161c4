#include "filters/model.h"

namespace shadowbench::filters {
namespace {

template <class T>
class Box4x4 {
  using P = Position<T>;

 public:
  explicit Box4x4(const ModelInput& input) : map_(input) {}

  static Kernel kernel(const ParamValues&) { return Kernel::make_box(3); }

  T visibility(const Receiver& r, Tally& tally) const {
    const Pair x = place(r.uv.x), y = place(r.uv.y);
    const auto row = [&](P offset) {
      return mix(map_.compare_2x2(r, {x.low, offset}, r.depth, tally),
                 map_.compare_2x2(r, {x.high, offset}, r.depth, tally), x.share);
    };
    return mix(row(y.low), row(y.high), y.share) + make_uncertain<T>(0, bound_placement());
  }

 private:
  /// The two fetches of one axis.
  struct Pair {
    P low{}, high{};  ///< offsets in texels
    T share{};        ///< of the high one
  };

  DepthReader<T> map_;

  Pair place(float uv) const {
    const P s = map_.grid().fraction(uv);
    return {P(1) / (P(2) - s) - P(1) - s, s / (P(1) + s) + P(1) - s, (T(P(1)) + T(s)) / T(P(3))};
  }

  /// Bounds what the rounding of s does to visibility. In units of 2^-24 s is 8 map sizes off (two divisions, a
  /// subtraction); the share moves by a third of that, the offsets by at most three quarters and 6 of their own.
  /// Visibility moves by no more than their sum, once for each axis.
  double bound_placement() const { return 18.0 * kUnitRoundoff * (static_cast<double>(map_.grid().size()) + 1.0); }
};

}  // namespace

ScalarModel make_box4x4_model() { return make_templated_model<Box4x4>(); }

}  // namespace shadowbench::filters
