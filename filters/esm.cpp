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
        radius_(static_cast<int>(number(input.values, "radius"))),
        falls_back_(text_or(input.values, "fallback", "none") != "none"),
        depths_(input),
        map_(input, radius_, [this](const EncodeInput<T>& e) { return encode(e.depth); }) {}

  static Kernel kernel(const ParamValues& values) { return EncodedMap<T, 1>::kernel(values); }

  T visibility(const Receiver& r, Tally& tally) const {
    const T occluder = map_.fetch(r, tally)[0];
    const T receiver = T(c_) * T(static_cast<P>(r.depth));
    const T lit = log_ ? exponential(occluder - receiver, accuracy_) : occluder * exponential(-receiver, accuracy_);
    if (!falls_back_) return minimum(lit, T(P(1)));
    if (std::abs(value_of(lit) - kLimit) <= bound_of(lit)) tally.excused = true;
    return value_of(lit) > kLimit ? compare_kernel(r, tally) : minimum(lit, T(P(1)));
  }

 private:
  static constexpr double kLimit = 1.5;  ///< of the filtered test, above which it is not believed

  GlAccuracy accuracy_;
  P c_;
  bool log_;
  int radius_;
  bool falls_back_;
  DepthReader<T> depths_;
  EncodedMap<T, 1> map_;

  /// Percentage-closer filtering by the prefilter's kernel; each texel is biased by its own distance.
  T compare_kernel(const Receiver& r, Tally& tally) const {
    T lit{};
    P all{};
    for (int y = -radius_; y <= radius_; ++y) {
      for (int x = -radius_; x <= radius_; ++x) {
        const P weight =
            std::exp(P(-2) * static_cast<P>(x * x + y * y) / static_cast<P>(std::max(radius_ * radius_, 1)));
        const P bias = static_cast<P>(r.bias_per_texel.x) * (static_cast<P>(std::abs(x)) + P(0.5)) +
                       static_cast<P>(r.bias_per_texel.y) * (static_cast<P>(std::abs(y)) + P(0.5));
        const float depth = static_cast<float>(static_cast<P>(r.depth) - bias);
        lit = lit + T(weight) * depths_.compare_2x2(r, {static_cast<P>(x), static_cast<P>(y)}, depth, tally);
        all += weight;
      }
    }
    return lit / T(all);
  }

  std::array<T, 1> encode(T depth) const {
    const T exponent = T(c_) * depth;
    return {log_ ? exponent : exponential(exponent, accuracy_)};
  }
};

}  // namespace

ScalarModel make_esm_model() { return make_templated_model<Esm>(); }

}  // namespace shadowbench::filters
