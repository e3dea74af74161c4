#include "filters/model.h"
#include "filters/penumbra.h"
#include "filters/random.h"

namespace shadowbench::filters {
namespace {

template <class T>
class Dpcf {
  using P = Position<T>;
  using Disk = PenumbraDisk<T>;

 public:
  explicit Dpcf(const ModelInput& input) : map_(input), accuracy_(input.accuracy), taps_(input), disk_(input.values) {}

  T visibility(const Receiver& r, Tally& tally) const {
    const P search = disk_.radius(r, static_cast<P>(r.depth_unbiased), tally);
    if (search < Disk::kOneFetch) return map_.compare_2x2(r, {}, r.depth, tally);
    const DiskTurn<T> turn(taps_, r);
    Blockers found;
    for (const glm::vec2& point : taps_.points) add_tap(r, turn.place(search, point), found, tally);
    if (found.depths == P(0)) return T(P(1));
    const P blocker = found.depths / static_cast<P>(value_of(found.weight));
    const P radius = disk_.radius(r, static_cast<P>(r.depth) - blocker, tally);
    if (radius < Disk::kOneFetch) return map_.compare_2x2(r, {}, r.depth, tally);
    tally.disk_radius_texels = static_cast<double>(radius);
    const T half(P(0.5)), blocked = found.weight / T(static_cast<P>(taps_.points.size()));
    return minimum(maximum(half + (half - blocked) * T(search / radius), T(P(0))), T(P(1)));
  }

 private:
  struct Blockers {
    P depths{};  ///< weighted
    T weight{};
  };

  DepthReader<T> map_;
  GlAccuracy accuracy_;
  TurnedDisk taps_;
  Disk disk_;

  /// A gather aims half-way between texels, and a texel that rounding swaps for the next one weighs next to nothing.
  void add_tap(const Receiver& r, const Offset<T>& offset, Blockers& found, Tally& tally) const {
    const P place_x = map_.grid().fraction(r.uv.x), place_y = map_.grid().fraction(r.uv.y);
    const P texel_x = std::floor(place_x + offset.x), texel_y = std::floor(place_y + offset.y);
    const T x = sampler_weight<T>(place_x + offset.x, texel_x, accuracy_, map_.grid().size());
    const T y = sampler_weight<T>(place_y + offset.y, texel_y, accuracy_, map_.grid().size());
    const Offset<T> gather{texel_x + P(0.5) - place_x, texel_y + P(0.5) - place_y};
    const std::array<float, 4> depths = map_.gather_depth(r, gather, tally);
    const float plane = map_.corner_depth(r, gather, Disk::biased(r, offset), tally);
    const T one(P(1)), weights[4] = {(one - x) * y, x * y, x * (one - y), (one - x) * (one - y)};
    for (std::size_t i = 0; i < 4; ++i) {
      if (Disk::is_close(depths[i], plane)) tally.excused = true;
      if (!(depths[i] < plane)) continue;
      found.depths += static_cast<P>(value_of(weights[i])) * static_cast<P>(depths[i]);
      found.weight = found.weight + weights[i];
    }
  }
};

}  // namespace

ScalarModel make_dpcf_model() { return make_templated_model<Dpcf>(); }

}  // namespace shadowbench::filters
