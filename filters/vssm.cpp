#include "filters/encoded_map.h"
#include "filters/model.h"
#include "filters/penumbra/penumbra_disk.h"
#include "filters/summed_area.h"

namespace shadowbench::filters {
namespace {

template <class T>
class Vssm {
  using P = Position<T>;

 public:
  explicit Vssm(const ModelInput& input)
      : variance_(input),
        max_radius_(static_cast<int>(number(input.values, "max_radius"))),
        moments_(input, longest_box_side(max_radius_),
                 [this](const EncodeInput<T>& e) { return variance_.encode(e); }) {}

  /// Every receiver has a box of its own.
  static std::optional<Kernel> kernel(const ParamValues&) { return std::nullopt; }

  T visibility(const Receiver& r, Tally& tally) const {
    const T widening(kBoxOfDisk * P(0.5) * static_cast<P>(r.light_size) * static_cast<P>(r.depth_range_ws) /
                     static_cast<P>(r.texel_size_ws));
    const T depth(static_cast<P>(r.depth)), lit(P(1));
    const T widest(std::max(static_cast<P>(max_radius_), kLeastHalfWidth));
    const auto half_width_of = [&](const T& above) {
      return widening * above / T(PenumbraDisk<T>::shrink(r, static_cast<P>(value_of(above))));
    };
    const T search = limit(half_width_of(T(static_cast<P>(r.depth_unbiased))), widest);
    const auto around = moments_around(r, search, tally);
    const T distance = depth - around[0];
    excuse_near_zero(distance, tally);
    if (value_of(distance) <= 0.0) return lit;
    const T to_blockers = distance + variance_.variance(around) / distance;
    const T half_width = limit(half_width_of(to_blockers), search);
    tally.disk_radius_texels = value_of(half_width) / static_cast<double>(kBoxOfDisk);
    return variance_.visibility(moments_around(r, half_width, tally), r.depth);
  }

 private:
  static constexpr P kLeastHalfWidth = P(0.5);
  static constexpr P kBoxOfDisk = P(0.8660254);
  static constexpr double kUncertain = 0.5;  // texels: a box of a width so far off says nothing

  Variance<T> variance_;
  int max_radius_;
  SummedMoments<T> moments_;

  /// Above 0 the blockers' distance has a pole, and at 0 the receiver is lit.
  static void excuse_near_zero(const T& distance, Tally& tally) {
    if (std::abs(value_of(distance)) <= bound_of(distance)) tally.excused = true;
  }

  static T limit(T half_width, T widest) { return minimum(maximum(half_width, T(kLeastHalfWidth)), widest); }

  /// The moments of a box, and, in tracked precision, how much they change where its width is as far off as it may be.
  std::array<T, 2> moments_around(const Receiver& r, const T& half_width, Tally& tally) const {
    const P x = static_cast<P>(r.uv.x) * moments_.size(), y = static_cast<P>(r.uv.y) * moments_.size();
    const auto mean = [&](double w) {
      const P reach = static_cast<P>(w);
      return moments_.mean({x - reach, y - reach}, {x + reach, y + reach});
    };
    auto moments = mean(value_of(half_width));
    if constexpr (std::is_same_v<T, Tracked>) {
      const double off = std::min(half_width.bound, kUncertain);
      if (half_width.bound > kUncertain) tally.excused = true;
      const auto narrower = mean(half_width.value - off), wider = mean(half_width.value + off);
      for (std::size_t c = 0; c < 2; ++c)
        moments[c].bound +=
            std::max(std::abs(narrower[c].value - moments[c].value), std::abs(wider[c].value - moments[c].value));
    }
    return moments;
  }
};

}  // namespace

std::unique_ptr<ScalarModel> make_vssm_model() { return make_templated_model<Vssm>(); }

}  // namespace shadowbench::filters
