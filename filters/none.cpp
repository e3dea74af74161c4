#include "filters/model.h"

namespace shadowbench::filters {
namespace {

template <class T>
class NoFilter {
 public:
  explicit NoFilter(const ModelInput& input) : map_(input) {}

  static Kernel kernel(const ParamValues&) { return Kernel::make_point(Reconstruction::kNearest); }

  T visibility(const Receiver& r, Tally& tally) const { return map_.compare_nearest(r, {}, r.depth, tally); }

 private:
  DepthReader<T> map_;
};

}  // namespace

ScalarModel make_none_model() { return make_templated_model<NoFilter>(); }

}  // namespace shadowbench::filters
