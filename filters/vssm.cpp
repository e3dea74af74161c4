#include "filters/encoded_map.h"
#include "filters/model.h"
#include "filters/penumbra.h"

namespace shadowbench::filters {
namespace {

template <class T>
class Vssm {
  using P = Position<T>;

 public:
  explicit Vssm(const ModelInput& input)
      : variance_(input), box_(input, [this](const EncodeInput<T>& e) { return variance_.encode(e); }) {}

  T visibility(const Receiver& r, Tally& tally) const {
    const T search = box_.search(r);
    const auto around = box_.moments(r, search, tally);
    const T distance = T(static_cast<P>(r.depth)) - around[0];
    excuse_near_zero(distance, tally);
    if (value_of(distance) <= 0.0) return T(P(1));
    const T to_blockers = distance + variance_.variance(around) / distance;
    const T half_width = box_.half_width(r, to_blockers, search);
    tally.disk_radius_texels = box_.disk_radius(half_width);
    return variance_.visibility(box_.moments(r, half_width, tally), r.depth);
  }

 private:
  Variance<T> variance_;
  PenumbraBox<T, 2> box_;

  /// Above 0 the blockers' distance has a pole, and at 0 the receiver is lit.
  static void excuse_near_zero(const T& distance, Tally& tally) {
    if (std::abs(value_of(distance)) <= bound_of(distance)) tally.excused = true;
  }
};

}  // namespace

ScalarModel make_vssm_model() { return make_templated_model<Vssm>(); }

}  // namespace shadowbench::filters
