#include "filters/encoded_map.h"
#include "filters/model.h"

namespace shadowbench::filters {
namespace {

template <class T>
class Vsm {
 public:
  explicit Vsm(const ModelInput& input)
      : variance_(input),
        map_(input, static_cast<int>(number(input.values, "radius")),
             [this](const EncodeInput<T>& e) { return variance_.encode(e); }) {}

  static Kernel kernel(const ParamValues& values) { return EncodedMap<T, 2>::kernel(values); }

  T visibility(const Receiver& r, Tally& tally) const { return variance_.visibility(map_.fetch(r, tally), r.depth); }

 private:
  Variance<T> variance_;
  EncodedMap<T, 2> map_;
};

}  // namespace

ScalarModel make_vsm_model() { return make_templated_model<Vsm>(); }

}  // namespace shadowbench::filters
