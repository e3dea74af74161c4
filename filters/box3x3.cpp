#include "filters/model.h"

namespace shadowbench::filters {
namespace {

template <class T>
class Box3x3 {
 public:
  explicit Box3x3(const ModelInput& input) : map_(input) {}

  static Kernel kernel(const ParamValues&) { return Kernel::make_box(3, Reconstruction::kNearest); }

  T visibility(const Receiver& r, Tally& tally) const {
    using P = Position<T>;
    T sum{};
    for (const P y : {P(-1), P(0), P(1)})
      for (const P x : {P(-1), P(0), P(1)}) sum = sum + map_.compare_nearest(r, {x, y}, r.depth, tally);
    return sum / T(P(9));
  }

 private:
  DepthReader<T> map_;
};

}  // namespace

ScalarModel make_box3x3_model() { return make_templated_model<Box3x3>(); }

}  // namespace shadowbench::filters
