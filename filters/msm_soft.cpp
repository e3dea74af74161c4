#include "filters/moments.h"
#include "filters/penumbra.h"

namespace shadowbench::filters {
namespace {

template <class T>
class MsmSoft {
  using P = Position<T>;
  using S = std::conditional_t<std::is_same_v<T, Tracked>, double, T>;

 public:
  explicit MsmSoft(const ModelInput& input)
      : box_(input, [](const EncodeInput<T>& e) { return four_moments::encode(e.depth); }),
        bias_(static_cast<float>(number(input.values, "moment_bias"))) {}

  T visibility(const Receiver& r, Tally& tally) const {
    const S depth(static_cast<P>(r.depth));
    const auto around = box_.moments(r, box_.search(r), tally);
    const auto finds_some = [&](const Stored& moved) { return find_light(moved, depth) < S(1) ? S(1) : S(0); };
    const T some = four_moments::track(around, bias_, finds_some);
    if (value_of(some) == 0.0 && bound_of(some) == 0.0) return T(P(1));
    const T found = light_of_blockers(r, around, tally);
    if (bound_of(some) == 0.0) return found;
    return make_uncertain<T>(value_of(some) == 0.0 ? P(1) : static_cast<P>(value_of(found)),
                             bound_of(found) + std::abs(1.0 - value_of(found)));
  }

 private:
  using Stored = std::array<S, 4>;
  static constexpr double kUnseen = 2e-3;    // of light
  static constexpr double kUncertain = 0.5;  // texels: a box of a width so far off is any

  PenumbraBox<T, 4> box_;
  float bias_;

  /// The light where blockers were found in the moments of the search.
  T light_of_blockers(const Receiver& r, const std::array<T, 4>& around, Tally& tally) const {
    const S depth(static_cast<P>(r.depth));
    const T above =
        four_moments::track(around, bias_, [&](const Stored& moved) { return find_blockers(moved, depth); });
    const T half_width = box_.half_width(r, above, box_.search(r));
    tally.disk_radius_texels = box_.disk_radius(half_width);
    if (bound_of(half_width) > kUncertain) {
      const double missing = find_missing_light(r, half_width, tally);
      if (missing < kUnseen) return make_uncertain<T>(P(1), missing);
    }
    return light_in(r, half_width, tally);
  }

  T light_in(const Receiver& r, const T& half_width, Tally& tally) const {
    const S depth(static_cast<P>(r.depth));
    return four_moments::track(box_.moments(r, half_width, tally), bias_,
                               [&](const Stored& moved) { return find_light(moved, depth); });
  }

  /// The most light that a receiver lacks in the narrowest and the widest box that it may have, and in some between.
  double find_missing_light(const Receiver& r, const T& half_width, Tally& tally) const {
    const double least = value_of(box_.half_width(r, T(P(0)), box_.search(r))), most = value_of(box_.search(r));
    const double low = std::max(value_of(half_width) - bound_of(half_width), least);
    const double high = std::min(value_of(half_width) + bound_of(half_width), most);
    double missing = 0.0;
    for (const double between : {0.0, 0.25, 0.5, 1.0}) {
      const T light = light_in(r, T(static_cast<P>(low + between * (high - low))), tally);
      missing = std::max(missing, 1.0 - value_of(light) + bound_of(light));
    }
    return missing;
  }

  S find_light(const Stored& stored, S depth) const {
    return four_moments::find_light(Depths::kAny, stored, depth, S(bias_));
  }

  /// How far above the receiver blockers are, in depth. Requires that there are some.
  S find_blockers(const Stored& stored, S depth) const {
    const auto moments = four_moments::decode(stored, S(bias_));
    const S x = S(2) * depth - S(1);
    return S(0.5) * four_moments::distance_to_blockers(moments, x, four_moments::solve(moments, x));
  }
};

}  // namespace

ScalarModel make_msm_soft_model() { return make_templated_model<MsmSoft>(); }

}  // namespace shadowbench::filters
