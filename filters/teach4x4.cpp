#include "filters/model.h"

namespace shadowbench::filters {
namespace {

template <class T>
class Teach4x4 {
 public:
  explicit Teach4x4(const ModelInput& input) : map_(input) {}

  static Kernel kernel(const ParamValues&) {
    return Kernel::make_grid({{-1.0, 0.5}, {1.0, 0.5}}, Reconstruction::kBilinear);
  }

  T visibility(const Receiver& r, Tally& tally) const {
    using P = Position<T>;
    T sum{};
    for (const P y : {P(-1), P(1)})
      for (const P x : {P(-1), P(1)}) sum = sum + map_.compare_2x2(r, {x, y}, r.depth, tally);
    return T(P(0.25)) * sum;
  }

 private:
  DepthReader<T> map_;
};

}  // namespace

std::unique_ptr<Model> make_teach4x4_model() { return make_templated_model<Teach4x4>(); }

}  // namespace shadowbench::filters
