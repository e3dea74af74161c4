#include "filters/encoded_map.h"
#include "filters/model.h"

namespace shadowbench::filters {
namespace {

template <class T>
class VsmSat {
  using P = Position<T>;

 public:
  explicit VsmSat(const ModelInput& input)
      : variance_(input),
        radius_(static_cast<int>(number(input.values, "radius"))),
        moments_(input, longest_box_side(radius_), [this](const EncodeInput<T>& e) { return variance_.encode(e); }) {}

  static Kernel kernel(const ParamValues& values) {
    return Kernel::make_box(2 * static_cast<int>(number(values, "radius")) + 1);
  }

  T visibility(const Receiver& r, Tally&) const {
    return variance_.visibility(moments_.around(r, static_cast<P>(radius_) + P(0.5)), r.depth);
  }

 private:
  Variance<T> variance_;
  int radius_;
  SummedMoments<T, 2> moments_;
};

}  // namespace

ScalarModel make_vsm_sat_model() { return make_templated_model<VsmSat>(); }

}  // namespace shadowbench::filters
