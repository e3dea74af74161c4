#include "filters/encoded_map.h"
#include "filters/moments.h"
#include "filters/penumbra.h"
#include "filters/random.h"

namespace shadowbench::filters {
namespace {

template <class T>
class Evssm {
  using P = Position<T>;
  using Moments = std::array<T, 4>;

 public:
  explicit Evssm(const ModelInput& input)
      : warps_(input, Warps<T>::read(input.values, "c"), Warps<T>::read(input.values, "c_down")),
        levels_(input, [this](const EncodeInput<T>& e) { return warps_.encode(e.depth); }),
        taps_(input),
        widest_(std::max(P(0.5) * Warps<T>::read(input.values, "max_radius"), kLeastRadius)),
        reduction_(Warps<T>::read(input.values, "bleed_reduction")) {}

  T visibility(const Receiver& r, Tally& tally) const {
    const T zero(P(0)), one(P(1)), depth(static_cast<P>(r.depth));
    if (r.depth > 1.0f) return zero;
    if (r.uv != glm::clamp(r.uv, 0.0f, 1.0f)) return one;
    const T search = radius_of(r, T(static_cast<P>(r.depth_unbiased)), widest_);
    const auto [lit, nearness] = change_by_radius(search, [&](const T& R) { return look_around(r, R); });
    if (is_sure(lit, tally)) return doubt(value_of(lit) > 0.5 ? one : zero, lit);
    const T radius = radius_of(r, depth - warps_.depth_of_blockers(depth, nearness, lit), search);
    tally.disk_radius_texels = value_of(radius);
    const DiskTurn<T> turn(taps_, r);
    const auto average = [&](const T& R) { return std::array{warps_.bound_light(fetch_disk(r, R, turn), depth)}; };
    const T light = change_by_radius(radius, average)[0];
    return doubt(maximum(light - T(reduction_), zero) / (one - T(reduction_)), lit);
  }

 private:
  static constexpr P kLeastRadius = P(1);
  static constexpr double kSure = 2e-3;
  static constexpr double kTie = 2e-5;
  static constexpr double kUncertain = 0.5;  // texels: a disk of a radius so far off says nothing

  Warps<T> warps_;
  MipLevels<T, 4> levels_;
  TurnedDisk taps_;
  P widest_;
  P reduction_;

  /// The radius of the penumbra that a blocker so far above the receiver makes, within its limits.
  static T radius_of(const Receiver& r, const T& above, const T& widest) {
    return minimum(maximum(PenumbraDisk<T>::widen(r, above, P(1)), T(kLeastRadius)), widest);
  }

  static double beyond_sure(const T& lit) { return std::min(value_of(lit), 1.0 - value_of(lit)) - kSure; }

  /// Whether all around is as good as lit, or as good as blocked; excused at a tie.
  static bool is_sure(const T& lit, Tally& tally) {
    if (std::abs(beyond_sure(lit)) < kTie) tally.excused = true;
    return beyond_sure(lit) < 0.0;
  }

  /// Nothing bounds a result where rounding may decide whether all around is sure.
  static T doubt(T light, const T& lit) {
    if constexpr (std::is_same_v<T, Tracked>)
      if (std::abs(beyond_sure(lit)) <= lit.bound) light.bound = HUGE_VAL;
    return light;
  }

  Moments fetch_wide(const Receiver& r, const Offset<T>& offset, const T& side) const {
    const int level = static_cast<int>(std::floor(std::log2(value_of(side))));
    const T coarser = (side * side * T(std::exp2(P(-2) * static_cast<P>(level))) - T(P(1))) / T(P(3));
    return mix(levels_.fetch(r, offset, level), levels_.fetch(r, offset, level + 1), coarser);
  }

  Moments fetch_disk(const Receiver& r, const T& radius, const DiskTurn<T>& turn) const {
    const P all = static_cast<P>(value_of(radius)), count = static_cast<P>(taps_.points.size());
    const P side = std::max(all / std::sqrt(count), kLeastRadius),
            reach = std::sqrt(std::max(all * all - side * side, P(0)));
    Moments sum{};
    for (const glm::vec2& point : taps_.points) {
      const Moments tap = fetch_wide(r, turn.place(reach, point), T(side));
      for (std::size_t c = 0; c < 4; ++c) sum[c] = sum[c] + tap[c];
    }
    for (T& channel : sum) channel = channel / T(count);
    return sum;
  }

  /// The light around a receiver, and the mean of the negative warp.
  std::array<T, 2> look_around(const Receiver& r, const T& radius) const {
    const Moments around = fetch_wide(r, {}, radius);
    return {warps_.bound_light(around, T(static_cast<P>(r.depth))), around[2]};
  }

  /// What `find` finds for a radius, and, in tracked precision, how much that changes where the radius, and with it the
  /// taps' places, are as far off as they may be.
  template <class Find>
  static auto change_by_radius(const T& radius, Find find) {
    auto found = find(T(static_cast<P>(value_of(radius))));
    if constexpr (std::is_same_v<T, Tracked>) {
      if (!(radius.bound < kUncertain)) {
        for (T& each : found) each.bound = HUGE_VAL;
        return found;
      }
      const double off = radius.bound + PenumbraDisk<T>::kRounding;
      return widen_bounds(found, find(T(std::max(radius.value - off, 1.0))), find(T(radius.value + off)));
    } else {
      return found;
    }
  }
};

}  // namespace

ScalarModel make_evssm_model() { return make_templated_model<Evssm>(); }

}  // namespace shadowbench::filters
