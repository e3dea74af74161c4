#include <cmath>
#include <numbers>

#include "filters/encoded_map.h"
#include "filters/model.h"

namespace shadowbench::filters {
namespace {

constexpr std::size_t kTerms = 4;

template <class T>
class CsmConv {
  using P = Position<T>;
  using Waves = std::array<T, kTerms>;

 public:
  explicit CsmConv(const ModelInput& input)
      : cosines_(make_map(input, [](const T& angle) { return cosine(angle); })),
        sines_(make_map(input, [](const T& angle) { return sine(angle); })),
        damping_(static_cast<P>(number(input.values, "damping"))),
        scale_(static_cast<P>(number(input.values, "scale"))) {}

  static Kernel kernel(const ParamValues& values) { return Kernel::make_box(2 * radius_of(values) + 1); }

  T visibility(const Receiver& r, Tally& tally) const {
    if (r.depth > 1.0f) return T(P(0));
    if (r.uv != glm::clamp(r.uv, 0.0f, 1.0f)) return T(P(1));
    const Waves cosines = cosines_.fetch(r, tally), sines = sines_.fetch(r, tally);
    T sum{};
    for (std::size_t i = 0; i < kTerms; ++i) {
      const T angle = T(frequency(i)) * T(static_cast<P>(r.depth));
      const P place = static_cast<P>(i + 1) / static_cast<P>(kTerms);
      const T weight(std::exp(-damping_ * place * place) / frequency(i));
      sum = sum + weight * (cosine(angle) * sines[i] - sine(angle) * cosines[i]);
    }
    return minimum(maximum(T(scale_) * (T(P(0.5)) + T(P(2)) * sum), T(P(0))), T(P(1)));
  }

 private:
  EncodedMap<T, kTerms> cosines_;
  EncodedMap<T, kTerms> sines_;
  P damping_;
  P scale_;

  static int radius_of(const ParamValues& values) { return static_cast<int>(number(values, "radius")); }
  static P frequency(std::size_t i) { return std::numbers::pi_v<P> * static_cast<P>(2 * i + 1); }
  static T cosine(const T& angle) {
    return wave(
        angle, [](auto x) { return std::cos(x); });
  }
  static T sine(const T& angle) {
    return wave(
        angle, [](auto x) { return std::sin(x); });
  }

  template <class Wave>
  static EncodedMap<T, kTerms> make_map(const ModelInput& input, Wave wave_of) {
    return EncodedMap<T, kTerms>::make_boxes(
        input, "rgba16f", radius_of(input.values),
        [&](const EncodeInput<T>& e) {
          Waves waves;
          for (std::size_t i = 0; i < kTerms; ++i) waves[i] = wave_of(T(frequency(i)) * e.depth);
          return waves;
        });
  }
};

}  // namespace

ScalarModel make_csm_conv_model() { return make_templated_model<CsmConv>(); }

}  // namespace shadowbench::filters
