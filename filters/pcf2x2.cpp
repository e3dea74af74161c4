#include "filters/model.h"

namespace shadowbench::filters {
namespace {

template <class T>
class Pcf2x2 {
 public:
  explicit Pcf2x2(const ModelInput& input) : map_(input) {}

  static Kernel kernel(const ParamValues&) { return Kernel::make_point(Reconstruction::kBilinear); }

  T visibility(const Receiver& r, Tally& tally) const { return map_.compare_2x2(r, {}, r.depth, tally); }

 private:
  DepthReader<T> map_;
};

}  // namespace

ScalarModel make_pcf2x2_model() { return make_templated_model<Pcf2x2>(); }

}  // namespace shadowbench::filters
