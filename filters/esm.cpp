#include "filters/encoded_map.h"
#include "filters/model.h"

namespace shadowbench::filters {
namespace {

template <class T>
class Esm {
  using P = Position<T>;

 public:
  explicit Esm(const ModelInput& input)
      : accuracy_(input.accuracy),
        c_(static_cast<P>(static_cast<float>(number(input.values, "c")))),
        log_(text_or(input.values, "combine", "linear") == "log"),
        map_(input, static_cast<int>(number(input.values, "radius")),
             [this](const EncodeInput<T>& e) { return encode(e.depth); }) {}

  static Kernel kernel(const ParamValues& values) { return EncodedMap<T, 1>::kernel(values); }

  T visibility(const Receiver& r, Tally& tally) const {
    const T occluder = map_.fetch(r, tally)[0];
    const T receiver = T(c_) * T(static_cast<P>(r.depth));
    const T lit(P(1));
    if (log_) return minimum(exponential(occluder - receiver, accuracy_), lit);
    return minimum(occluder * exponential(-receiver, accuracy_), lit);
  }

 private:
  GlAccuracy accuracy_;
  P c_;
  bool log_;
  EncodedMap<T, 1> map_;

  std::array<T, 1> encode(T depth) const {
    const T exponent = T(c_) * depth;
    return {log_ ? exponent : exponential(exponent, accuracy_)};
  }
};

}  // namespace

std::unique_ptr<Model> make_esm_model() { return make_templated_model<Esm>(); }

}  // namespace shadowbench::filters
