#include <cmath>
#include <numbers>

#include "filters/disk_points.h"
#include "filters/model.h"
#include "filters/random.h"

namespace shadowbench::filters {
namespace {

template <class T>
class Pcss {
  using P = Position<T>;

 public:
  explicit Pcss(const ModelInput& input)
      : map_(input),
        points_(generate_disk_points(input.spec, input.values, "disk_points")),
        search_points_(generate_disk_points(input.spec, input.values, "search_points")),
        max_radius_(static_cast<P>(number(input.values, "max_radius"))),
        rotation_(text_or(input.values, "rotation", "none")),
        seed_(input.seed) {}

  /// Every receiver has a disk of its own.
  static std::optional<Kernel> kernel(const ParamValues&) { return std::nullopt; }

  T visibility(const Receiver& r, Tally& tally) const {
    const P widening =
        P(0.5) * static_cast<P>(r.light_size) * static_cast<P>(r.depth_range_ws) / static_cast<P>(r.texel_size_ws);
    const P depth = static_cast<P>(r.depth), search = limit(widening * static_cast<P>(r.depth_unbiased), tally);
    if (search < kOneFetch) return map_.compare_2x2(r, {}, r.depth, tally);
    const P angle = P(2) * std::numbers::pi_v<P> * static_cast<P>(turn_of(rotation_, r.pixel, seed_));
    const Turn turn{std::cos(angle), std::sin(angle)};
    Tally search_tally;
    const std::optional<P> blocker = find_blocker(r, search, turn, search_tally);
    if (search_tally.excused) tally.excused = true;
    if (!blocker) return T(P(1));
    const P radius = limit(widening * (depth - *blocker), tally);
    if (radius < kOneFetch) return map_.compare_2x2(r, {}, r.depth, tally);
    tally.disk_radius_texels = static_cast<double>(radius);
    T sum{};
    for (const glm::vec2& point : points_) {
      const Offset<T> offset = turn.place(radius, point);
      sum = sum + map_.compare_2x2(r, offset, static_cast<float>(biased(r, offset)), tally);
    }
    return sum / T(static_cast<P>(points_.size()));
  }

 private:
  static constexpr P kOneFetch = P(0.25);
  static constexpr P kRounding = P(1e-4);  // of radii and of the places of taps, texels

  struct Turn {
    P c, s;

    Offset<T> place(P radius, const glm::vec2& point) const {
      const P x = static_cast<P>(point.x), y = static_cast<P>(point.y);
      return {radius * (c * x - s * y), radius * (s * x + c * y)};
    }
  };

  DepthReader<T> map_;
  std::vector<glm::vec2> points_;
  std::vector<glm::vec2> search_points_;
  P max_radius_;
  std::string rotation_;
  std::uint32_t seed_;

  /// A radius within its limit. Rounding decides about those near the end of a single fetch.
  P limit(P radius, Tally& tally) const {
    const P limited = std::min(radius, max_radius_);
    if (std::abs(limited - kOneFetch) < kRounding) tally.excused = true;
    return limited;
  }

  static P biased(const Receiver& r, const Offset<T>& offset) {
    const P bias = static_cast<P>(r.bias_per_texel.x) * std::abs(offset.x) +
                   static_cast<P>(r.bias_per_texel.y) * std::abs(offset.y);
    return static_cast<P>(r.depth) - bias;
  }

  /// The mean depth of the blockers found.
  std::optional<P> find_blocker(const Receiver& r, P search, const Turn& turn, Tally& tally) const {
    P depths{}, blockers{};
    for (const glm::vec2& point : search_points_) {
      const Offset<T> offset = turn.place(search, point);
      const P depth = fetch(r, offset, tally);
      if (!(depth < biased(r, offset))) continue;
      depths += depth;
      blockers += P(1);
    }
    return blockers > P(0) ? std::optional(depths / blockers) : std::nullopt;
  }

  /// A texel of the search. Near a border between texels rounding decides which one it is, and where the depths differ
  /// that counts unless neither blocks.
  P fetch(const Receiver& r, const Offset<T>& offset, Tally& tally) const {
    Tally own;
    const P depth = static_cast<P>(map_.fetch_depth(r, offset, own)), plane = biased(r, offset);
    if (std::abs(depth - plane) < P(1e-7)) tally.excused = true;
    if (!own.excused) return depth;
    for (const P x : {-kRounding, kRounding}) {
      for (const P y : {-kRounding, kRounding}) {
        const P other = static_cast<P>(map_.fetch_depth(r, {offset.x + x, offset.y + y}, own));
        if (other != depth && std::min(other, depth) < plane) tally.excused = true;
      }
    }
    return depth;
  }
};

}  // namespace

std::unique_ptr<Model> make_pcss_model() { return make_templated_model<Pcss>(); }

}  // namespace shadowbench::filters
