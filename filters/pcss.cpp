#include "filters/model.h"
#include "filters/penumbra.h"
#include "filters/random.h"
#include "filters/screen.h"

namespace shadowbench::filters {
namespace {

template <class T>
class Pcss {
  using P = Position<T>;
  using Disk = PenumbraDisk<T>;

 public:
  explicit Pcss(const ModelInput& input)
      : map_(input),
        bail_(input.values),
        taps_(input),
        search_points_(generate_disk_points(input.spec, input.values, "search_points")),
        disk_(input.values),
        reads_one_(text_or(input.values, "read", "bilinear") == "nearest"),
        interpolates_(text_or(input.values, "read", "bilinear") == "interpolated") {
    bail_.order(taps_.points);
    bail_.order(search_points_);
  }

  T visibility(const Receiver& r, Tally& tally) const {
    const P search = disk_.radius(r, static_cast<P>(r.depth_unbiased), tally);
    if (search < Disk::kOneFetch) return compare_tap(r, {}, tally);
    const DiskTurn<T> turn(taps_, r);
    const std::optional<P> blocker = find_blocker(r, search, turn, tally);
    if (!blocker) return T(P(1));
    const P radius = disk_.radius(r, static_cast<P>(r.depth) - *blocker, tally);
    if (radius < Disk::kOneFetch) return compare_tap(r, {}, tally);
    tally.disk_radius_texels = static_cast<double>(radius);
    tally.screen_value = static_cast<double>(radius) * static_cast<double>(r.texel_size_ws);
    tally.screen_bound = static_cast<double>(Disk::kRounding) * static_cast<double>(r.texel_size_ws);
    return bail_.template average<T>(taps_.points, tally, [&](const glm::vec2& point) {
      const Offset<T> offset = turn.place(radius, point);
      return compare_tap(r, offset, tally);
    });
  }

  /// Where one of the pixels that count is excused, so is this one.
  static ModelResult screen(const ScreenPicture& picture, glm::ivec2 pixel, int step) {
    const glm::ivec2 axis = step == 0 ? glm::ivec2(1, 0) : glm::ivec2(0, 1);
    const ScreenPicture::Pixel& own = *picture.find(pixel);
    ModelResult result = own.result;
    T radii{};
    P found{};
    for (int i = -kBlurReach; i <= kBlurReach; i += 2) {
      const ScreenPicture::Pixel* there = picture.find(pixel + i * axis);
      if (!there) continue;
      result.excused = result.excused || there->result.excused;
      if (there->result.screen_value <= 0.0) continue;
      radii = radii + make_uncertain<T>(static_cast<P>(there->result.screen_value), there->result.screen_bound);
      found += P(1);
    }
    if (found == P(0)) return result;
    const T radius = radii / T(found), blurred = T(kBlurShare) * radius;
    T sum = make_uncertain<T>(static_cast<P>(own.result.visibility), own.result.bound), weights(P(1));
    for (int i = -kBlurReach; i <= kBlurReach; ++i) {
      const ScreenPicture::Pixel* there = picture.find(pixel + i * axis);
      if (!there || i == 0) continue;
      const T weight = near_on_surface<T>(own, *there, blurred);
      if (value_of(weight) > 0.0) result.excused = result.excused || there->result.excused;
      sum = sum + weight * make_uncertain<T>(static_cast<P>(there->result.visibility), there->result.bound);
      weights = weights + weight;
    }
    const T mean = sum / weights;
    result.visibility = value_of(mean);
    result.bound = bound_of(mean);
    result.screen_value = value_of(radius);
    result.screen_bound = bound_of(radius);
    return result;
  }

 private:
  static constexpr int kBlurReach = 4;     ///< pixels
  static constexpr P kBlurShare = P(0.5);  ///< of the penumbra's radius

  DepthReader<T> map_;
  EarlyBail bail_;
  TurnedDisk taps_;
  std::vector<glm::vec2> search_points_;
  Disk disk_;
  bool reads_one_;
  bool interpolates_;

  T compare_tap(const Receiver& r, const Offset<T>& offset, Tally& tally) const {
    if (interpolates_) return T(P(find_blocker_at(r, offset, tally) ? 0 : 1));
    const float z = Disk::biased(r, offset);
    return reads_one_ ? map_.compare_nearest(r, offset, z, tally) : map_.compare_2x2(r, offset, z, tally);
  }

  /// The mean depth of the blockers found.
  std::optional<P> find_blocker(const Receiver& r, P search, const DiskTurn<T>& turn, Tally& tally) const {
    P depths{}, blockers{};
    for (std::size_t i = 0; i < search_points_.size(); ++i) {
      const Offset<T> offset = turn.place(search, search_points_[i]);
      const std::optional<P> depth = find_blocker_at(r, offset, tally);
      if (depth) {
        depths += *depth;
        blockers += P(1);
      }
      if (blockers == P(0) && bail_.agrees(i, 0.0, tally)) return std::nullopt;
    }
    return blockers > P(0) ? std::optional(depths / blockers) : std::nullopt;
  }

  /// What a tap of the search reads, if it blocks.
  std::optional<P> find_blocker_at(const Receiver& r, const Offset<T>& offset, Tally& tally) const {
    Tally own;
    if (interpolates_) return interpolate_blocker(r, offset, tally);
    const float plane = map_.nearest_depth(r, offset, Disk::biased(r, offset), own);
    const float depth = Disk::read_depth(
        map_, r, offset, [&](float d) { return std::min(d, plane); }, tally);
    if (Disk::is_close(depth, plane)) tally.excused = true;
    return depth < plane ? std::optional(static_cast<P>(depth)) : std::nullopt;
  }

  /// The depth between four texels, if it blocks.
  std::optional<P> interpolate_blocker(const Receiver& r, const Offset<T>& offset, Tally& tally) const {
    const P x = map_.grid().fraction(r.uv.x) + offset.x, y = map_.grid().fraction(r.uv.y) + offset.y;
    const P u = x - std::floor(x), v = y - std::floor(y);
    const Offset<T> corner{offset.x + P(0.5) - u, offset.y + P(0.5) - v};
    const std::array<float, 4> depths = map_.gather_depth(r, corner, tally);
    const float plane = map_.corner_depth(r, corner, Disk::biased(r, offset), tally);
    const P weights[4] = {(1 - u) * v, u * v, u * (1 - v), (1 - u) * (1 - v)};
    P depth{};
    for (std::size_t i = 0; i < 4; ++i) depth += weights[i] * static_cast<P>(depths[i]);
    const auto [low, high] = std::ranges::minmax(depths);
    if (std::abs(depth - static_cast<P>(plane)) <= 4 * Disk::kRounding * static_cast<P>(high - low) + P(1e-7))
      tally.excused = true;
    return depth < static_cast<P>(plane) ? std::optional(depth) : std::nullopt;
  }
};

}  // namespace

ScalarModel make_pcss_model() { return make_templated_model<Pcss>(); }

}  // namespace shadowbench::filters
