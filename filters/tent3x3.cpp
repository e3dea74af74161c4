#include "filters/model.h"

namespace shadowbench::filters {
namespace {

template <class T>
class Tent3x3 {
 public:
  explicit Tent3x3(const ModelInput& input) : map_(input) {}

  static Kernel kernel(const ParamValues&) { return Kernel::make_box(2); }

  T visibility(const Receiver& r, Tally& tally) const {
    using P = Position<T>;
    T sum{};
    for (const P y : {P(-0.5), P(0.5)})
      for (const P x : {P(-0.5), P(0.5)}) sum = sum + map_.compare_2x2(r, {x, y}, r.depth, tally);
    return T(P(0.25)) * sum;
  }

 private:
  DepthReader<T> map_;
};

}  // namespace

std::unique_ptr<Model> make_tent3x3_model() { return make_templated_model<Tent3x3>(); }

}  // namespace shadowbench::filters
