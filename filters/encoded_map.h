#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <functional>
#include <optional>
#include <vector>

#include "filters/map_reader.h"
#include "filters/model.h"

namespace shadowbench::filters {

/// What encode() is told of a texel; the same in shaders/lib/filter.glsl, but for the sign of the slopes.
template <class T>
struct EncodeInput {
  T depth{};
  std::array<T, 2> slope{};  ///< |depth per texel| along u and v: of both sides of the texel the smaller
};

/// Visits the rows of a map, in parallel and in no order.
void visit_rows(int rows, const std::function<void(int row)>& visit);

/// mix() of each of several numbers.
template <class T, std::size_t N>
std::array<T, N> mix(const std::array<T, N>& a, const std::array<T, N>& b, const T& share) {
  std::array<T, N> result;
  for (std::size_t i = 0; i < N; ++i) result[i] = mix(a[i], b[i], share);
  return result;
}

/// The scalar model of the `encode` and `blur` passes: a map that a filter's encode() wrote, then prefiltered.
///
/// It has `N` channels of type T. Outside the map it holds what the map's border says: if that is depth 1, then depth 1
/// encoded.
template <class T, std::size_t N>
class EncodedMap {
 public:
  using Texel = std::array<T, N>;

  /// `encode` maps an EncodeInput<T> to a Texel. Reads `store`, `combine` and `sample` from the parameter values.
  template <class Encode>
  EncodedMap(const ModelInput& input, int radius_texels, Encode encode)
      : grid_(input.map.size, input.map.border, store_bytes(text_or(input.values, "store", "r32f"))),
        accuracy_(input.accuracy),
        store_(store_precision(text_or(input.values, "store", "r32f"))),
        log_(combines_logs(input.values)),
        nearest_(reads_nearest(input.values)) {
    fill(input, encode);
    if (radius_texels > 0) blur(gaussian_weights(radius_texels));
  }

  /// The map of a pass of a filter's own with steps = "axes": it begins with what `begin` makes of a texel, and takes
  /// the mean of a box. Outside the map its edge is repeated.
  template <class Begin>
  static EncodedMap make_boxes(const ModelInput& input, const std::string& store, int radius_texels, Begin begin) {
    EncodedMap map(input, store);
    map.fill(input, begin);
    map.divisor_ = static_cast<Position<T>>(2 * radius_texels + 1);
    map.blur(std::vector<float>(static_cast<std::size_t>(2 * radius_texels + 1), 1.0f));
    return map;
  }

  /// The prefilter's kernel, whose half-width is the parameter `radius`.
  static Kernel kernel(const ParamValues& values) {
    return Kernel::make_gaussian(static_cast<int>(number(values, "radius")),
                                 reads_nearest(values) ? Reconstruction::kNearest : Reconstruction::kBilinear);
  }

  const Texel& texel(int x, int y) const { return texel_at(grid_.find(x, y)); }

  Texel fetch(const Receiver& r, Tally& tally) const {
    if (nearest_) {
      const int x = grid_.nearest(grid_.position(r.uv.x, 0), tally);
      return read(x, grid_.nearest(grid_.position(r.uv.y, 0), tally));
    }
    const Position<T> half(0.5);
    const Position<T> px = grid_.position(r.uv.x, 0) - half, py = grid_.position(r.uv.y, 0) - half;
    // At a border the weights are continuous but their slope is not, which a propagated bound does not see.
    const int x = grid_.nearest(px, tally), y = grid_.nearest(py, tally);
    const T sx = sampler_weight<T>(px, std::floor(px), accuracy_, grid_.size());
    const T sy = sampler_weight<T>(py, std::floor(py), accuracy_, grid_.size());
    const Texel low = mix(read(x, y), read(x + 1, y), sx);
    const Texel high = mix(read(x, y + 1), read(x + 1, y + 1), sx);
    return mix(low, high, sy);
  }

  /// What lies at a receiver's place, moved by an offset, between texels; without the error of the place itself. Not
  /// for maps that are read with the nearest texel.
  Texel fetch_between(const Receiver& r, const Offset<T>& offset) const {
    using P = Position<T>;
    const P px = grid_.position(r.uv.x, offset.x) - P(0.5), py = grid_.position(r.uv.y, offset.y) - P(0.5);
    const int x = static_cast<int>(std::floor(px)), y = static_cast<int>(std::floor(py));
    const T sx(px - std::floor(px)), sy(py - std::floor(py));
    return mix(mix(texel(x, y), texel(x + 1, y), sx), mix(texel(x, y + 1), texel(x + 1, y + 1), sx), sy);
  }

  /// How far off, in texels, the sampler may read.
  double placement() const { return bound_sampler_weight(accuracy_, grid_.size()); }

 private:
  EncodedMap(const ModelInput& input, const std::string& store)
      : grid_(input.map.size, Border::kEdge, store_bytes(store)),
        accuracy_(input.accuracy),
        store_(store_precision(store)),
        log_(false),
        nearest_(false) {}

  template <class Encode>
  void fill(const ModelInput& input, Encode encode) {
    border_ = stored(encode(EncodeInput<T>{T(Position<T>(1)), {}}));
    const std::vector<T> depths = linear_depths(input.map);
    texels_ = make_texels([&](int x, int y) { return stored(encode(describe(depths, x, y))); });
  }

  template <class Make>
  std::vector<Texel> make_texels(const Make& make) const {
    const auto size = static_cast<std::size_t>(grid_.size());
    std::vector<Texel> texels(size * size);
    visit_rows(grid_.size(), [&](int y) {
      for (int x = 0; x < grid_.size(); ++x)
        texels[static_cast<std::size_t>(y) * size + static_cast<std::size_t>(x)] = make(x, y);
    });
    return texels;
  }

  void blur(const std::vector<float>& weights) {
    texels_ = blurred(weights, 1, 0);
    texels_ = blurred(weights, 0, 1);
  }

  /// The error of a depth that was linearised in single precision: the stored value may be read one ULP off, and the
  /// division rounds.
  static double linear_rounding(float depth, const DepthCurve& curve) {
    if (std::is_same_v<T, float> || curve.is_linear()) return 0.0;
    const auto z = static_cast<double>(depth);
    return depth_step(z, curve, {}) + 4.0 * kUnitRoundoff * z;
  }

  static std::vector<T> linear_depths(const DepthMap& map) {
    std::vector<T> depths;
    depths.reserve(map.stored.size());
    for (const float in_map : map.stored) {
      const float depth = map.curve.linear(in_map);
      depths.push_back(make_uncertain<T>(static_cast<Position<T>>(depth), linear_rounding(depth, map.curve)));
    }
    return depths;
  }

  /// At the map's edge a texel has its own depth for a neighbour, as in shaders/encode.frag.
  EncodeInput<T> describe(const std::vector<T>& depths, int x, int y) const {
    const auto at = [&](int column, int row) {
      const int last = grid_.size() - 1;
      return depths[static_cast<std::size_t>(std::clamp(row, 0, last)) * static_cast<std::size_t>(last + 1) +
                    static_cast<std::size_t>(std::clamp(column, 0, last))];
    };
    const T own = at(x, y);
    const auto slope = [&](const T& before, const T& after) {
      return minimum(absolute(after - own), absolute(own - before));
    };
    return {own, {slope(at(x - 1, y), at(x + 1, y)), slope(at(x, y - 1), at(x, y + 1))}};
  }

  TexelGrid<T> grid_;
  GlAccuracy accuracy_;
  StorePrecision store_;
  bool log_;
  bool nearest_;
  Position<T> divisor_ = Position<T>(1);  ///< of the sums of a blur whose weights do not sum to 1
  Texel border_{};
  std::vector<Texel> texels_;

  const Texel& texel_at(const std::optional<std::size_t>& place) const { return place ? texels_[*place] : border_; }

  /// A texel for a lookup, whose read is noted.
  const Texel& read(int x, int y) const { return texel_at(grid_.read(x, y)); }

  Texel stored(Texel texel) const {
    for (T& channel : texel) channel = round_to_store(channel, store_);
    return texel;
  }

  std::vector<Texel> blurred(const std::vector<float>& weights, int dx, int dy) const {
    const int radius = static_cast<int>(weights.size() / 2), size = grid_.size();
    return make_texels([&](int x, int y) {
      const int along = dx * x + dy * y;
      if (along < radius || along >= size - radius)
        return blend(weights, [&](int i) -> const Texel& { return texel(x + i * dx, y + i * dy); });
      const Texel* centre =
          &texels_[static_cast<std::size_t>(y) * static_cast<std::size_t>(size) + static_cast<std::size_t>(x)];
      return blend(weights, [centre, step = dx + dy * size](int i) -> const Texel& { return centre[i * step]; });
    });
  }

  /// `tap` gives the texel under each weight, counted from the middle one.
  template <class Tap>
  Texel blend(const std::vector<float>& weights, const Tap& tap) const {
    return stored(log_ ? add_logs(weights, tap) : add(weights, tap));
  }

  template <class Tap>
  Texel add(const std::vector<float>& weights, const Tap& tap_at) const {
    const int radius = static_cast<int>(weights.size() / 2);
    Texel sum{};
    for (int i = -radius; i <= radius; ++i) {
      const Texel& tap = tap_at(i);
      const T weight(static_cast<Position<T>>(weights[static_cast<std::size_t>(i + radius)]));
      for (std::size_t c = 0; c < N; ++c) sum[c] = sum[c] + weight * tap[c];
    }
    if (divisor_ == Position<T>(1)) return sum;
    for (T& channel : sum) channel = channel / T(divisor_);
    return sum;
  }

  /// ln(sum w e^x), shifted by the largest x so that nothing overflows.
  template <class Tap>
  Texel add_logs(const std::vector<float>& weights, const Tap& tap) const {
    const int radius = static_cast<int>(weights.size() / 2);
    Texel result;
    for (std::size_t c = 0; c < N; ++c) {
      T largest = tap(-radius)[c];
      for (int i = -radius; i <= radius; ++i) largest = maximum(largest, tap(i)[c]);
      T sum{};
      for (int i = -radius; i <= radius; ++i) {
        const T weight(static_cast<Position<T>>(weights[static_cast<std::size_t>(i + radius)]));
        sum = sum + weight * exponential(tap(i)[c] - largest, accuracy_);
      }
      result[c] = largest + logarithm(sum);
    }
    return result;
  }
};

/// What variance shadow maps store, and the light that two moments allow: the same as the functions of
/// filters/vsm.glsl.
template <class T>
class Variance {
  using P = Position<T>;

 public:
  explicit Variance(const ModelInput& input)
      : slope_variance_(read(input, "slope_variance")),
        min_variance_(read(input, "min_variance")),
        reduction_(read(input, "bleed_reduction")) {}

  std::array<T, 2> encode(const EncodeInput<T>& e) const {
    const T squared = e.slope[0] * e.slope[0] + e.slope[1] * e.slope[1];
    return {e.depth, e.depth * e.depth + T(slope_variance_) * squared};
  }

  T variance(const std::array<T, 2>& moments) const {
    return maximum(moments[1] - moments[0] * moments[0], T(min_variance_));
  }

  T visibility(const std::array<T, 2>& moments, float depth) const {
    const T zero(P(0)), one(P(1));
    const T distance = maximum(T(static_cast<P>(depth)) - moments[0], zero);
    const T variance = this->variance(moments);
    const T bound = value_of(variance) > 0.0 ? chebyshev(variance, distance) : value_of(distance) > 0.0 ? zero : one;
    return maximum(bound - T(reduction_), zero) / (one - T(reduction_));
  }

 private:
  P slope_variance_;
  P min_variance_;
  P reduction_;

  static P read(const ModelInput& input, const char* name) {
    return static_cast<P>(static_cast<float>(number(input.values, name)));
  }

  /// The GLSL's v / (v + d^2), written with one v: a propagated bound would count the error of the other one again.
  static T chebyshev(T variance, T distance) {
    const T one(P(1));
    return one / (one + distance * distance / variance);
  }
};

/// The longest side of a box that reaches `radius` texels beyond the receiver's own texel, wherever in that it stands:
/// the texels that it covers in part, and one to spare for what rounding moves it by.
inline int longest_box_side(int radius) { return 2 * radius + 3; }

/// The steps from 0 to 1 in which shaders/lib/summed_area.glsl counts a moment: as many as single precision tells
/// apart, and so few that a box with sides of `side` texels sums to less than 2^32.
template <class P>
P count_moment_steps(int side) {
  return std::min(P(16777216), std::floor(P(4e9) / static_cast<P>(side * side)));
}

/// Means of two or four moments over boxes of texels, as shaders/lib/summed_area.glsl makes them from its summed-area
/// table; `side` is the longest side of a box in texels. Whole numbers are added in single precision alone: elsewhere
/// the moments are as encode() gives them, and tracked precision knows by how much the steps move them.
template <class T, std::size_t N>
class SummedMoments {
  using P = Position<T>;

 public:
  using Moments = std::array<T, N>;

  template <class Encode>
  SummedMoments(const ModelInput& input, int side, Encode encode)
      : size_(input.map.size),
        memory_{size_, store_bytes(input.spec.passes.back().store)},
        steps_(count_moment_steps<P>(side)),
        outside_(encode(EncodeInput<T>{T(P(1)), {}})),
        table_(static_cast<std::size_t>(size_ * size_)) {
    const EncodedMap<T, N> map(input, 0, encode);
    for (int y = 0; y < size_; ++y)
      for (int x = 0; x < size_; ++x) table_[index(x, y)] = add(map.texel(x, y), x, y);
  }

  /// The moments of the box that reaches so many texels to each side of a receiver.
  Moments around(const Receiver& r, P reach) const {
    const P x = static_cast<P>(r.uv.x) * size(), y = static_cast<P>(r.uv.y) * size();
    return mean({x - reach, y - reach}, {x + reach, y + reach});
  }

 private:
  struct Sums {
    std::array<double, N> values{};
    std::array<double, N> bounds{};  ///< of single precision
  };

  int size_;
  MapMemory memory_;  ///< of the table
  P steps_;
  Moments outside_;
  std::vector<Sums> table_;

  P size() const { return static_cast<P>(size_); }

  /// The moments of a box between two corners, in texels from the map's lower left.
  Moments mean(const Offset<T>& low, const Offset<T>& high) const {
    Moments moments = mean_of(low, high);
    if constexpr (std::is_same_v<T, Tracked>) {
      for (int edge = 0; edge < 8; ++edge) {
        const Moments moved = move_edge(low, high, edge);
        for (std::size_t c = 0; c < N; ++c) moments[c].bound += 0.5 * std::abs(moved[c].value - moments[c].value);
      }
    }
    return moments;
  }

  /// What the table counts 1 as.
  P unit() const { return std::is_same_v<T, float> ? steps_ : P(1); }

  std::size_t index(int x, int y) const { return static_cast<std::size_t>(y * size_ + x); }

  Sums add(const Moments& moments, int x, int y) const {
    const Sums &left = at(x - 1, y), &below = at(x, y - 1), &both = at(x - 1, y - 1);
    Sums sums;
    for (std::size_t c = 0; c < N; ++c) {
      double value = value_of(moments[c]);
      value = value > 0.0 ? std::min(value, 1.0) : 0.0;  // what is no number becomes 0, as in the GL
      if constexpr (std::is_same_v<T, float>)
        value = static_cast<double>(std::floor(static_cast<float>(value) * steps_ + 0.5f));
      sums.values[c] = value + left.values[c] + below.values[c] - both.values[c];
      const double rounding = bound_of(moments[c]) + 1.0 / static_cast<double>(steps_);
      sums.bounds[c] = rounding + left.bounds[c] + below.bounds[c] - both.bounds[c];
    }
    return sums;
  }

  /// The sums of all texels up to this one; 0 below and left of the map.
  const Sums& at(int x, int y) const {
    static const Sums none;
    if (x < 0 || y < 0) return none;
    const std::size_t texel = index(std::min(x, size_ - 1), std::min(y, size_ - 1));
    if constexpr (ReadLog::hears<T>) ReadLog::note({&memory_, texel});
    return table_[texel];
  }

  /// Sums of whole texels with both ends, and what of them lies outside the map, where depth is 1.
  Moments window(glm::ivec2 from, glm::ivec2 to) const {
    const Sums &all = at(to.x, to.y), &left = at(from.x, to.y), &below = at(to.x, from.y), &both = at(from.x, from.y);
    const glm::ivec2 inside = glm::clamp(to, -1, size_ - 1) - glm::clamp(from, -1, size_ - 1);
    const int outside = (to.x - from.x) * (to.y - from.y) - inside.x * inside.y;
    Moments sum;
    for (std::size_t c = 0; c < N; ++c) {
      const double value = all.values[c] - left.values[c] - below.values[c] + both.values[c];
      const double bound = all.bounds[c] - left.bounds[c] - below.bounds[c] + both.bounds[c];
      sum[c] = make_uncertain<T>(static_cast<P>(value) / unit(), std::max(bound, 0.0)) +
               T(static_cast<P>(outside)) * outside_[c];
    }
    return sum;
  }

  Moments mean_of(const Offset<T>& low, const Offset<T>& high) const {
    const auto split = [](P at) { return std::pair(static_cast<int>(std::floor(at)) - 1, at - std::floor(at)); };
    const auto [left, left_part] = split(low.x);
    const auto [bottom, bottom_part] = split(low.y);
    const auto [right, right_part] = split(high.x);
    const auto [top, top_part] = split(high.y);
    const auto part = [](P fraction, int i) { return i == 0 ? P(1) - fraction : fraction; };
    Moments moments{};
    T area{};
    for (int i = 0; i < 16; ++i) {
      const glm::ivec2 from(left + (i & 1), bottom + (i >> 2 & 1)), to(right + (i >> 1 & 1), top + (i >> 3));
      const T weight(part(left_part, i & 1) * part(right_part, i >> 1 & 1) * part(bottom_part, i >> 2 & 1) *
                     part(top_part, i >> 3));
      const Moments sum = window(from, to);
      for (std::size_t c = 0; c < N; ++c) moments[c] = moments[c] + weight * sum[c];
      area = area + weight * T(static_cast<P>((to.x - from.x) * (to.y - from.y)));
    }
    for (T& moment : moments) moment = moment / area;
    return moments;
  }

  /// The mean with one edge off by as much as single precision may place it.
  Moments move_edge(Offset<T> low, Offset<T> high, int edge) const {
    const P off = P(4) * static_cast<P>(kUnitRoundoff) * size() * (edge % 2 == 0 ? P(1) : P(-1));
    P* const edges[] = {&low.x, &low.y, &high.x, &high.y};
    *edges[edge / 2] += off;
    return mean_of(low, high);
  }
};

/// The mip levels of an encoded map, each texel the mean of four of the level before: the map of a pass of a filter's
/// own with steps = "levels". Its side is the power of two that holds the map. Beyond the map its edge is repeated.
template <class T, std::size_t N>
class MipLevels {
  using P = Position<T>;

 public:
  using Texel = std::array<T, N>;

  template <class Encode>
  MipLevels(const ModelInput& input, Encode encode) : grid_(input.map.size), accuracy_(input.accuracy) {
    const EncodedMap<T, N> map(input, 0, encode);
    const int side = static_cast<int>(std::bit_ceil(static_cast<unsigned>(grid_.size()))), last = grid_.size() - 1;
    const int texel_bytes = store_bytes(input.spec.passes.back().store);
    levels_.push_back({TexelGrid<T>(side, Border::kEdge, texel_bytes), {}});
    for (int y = 0; y < side; ++y)
      for (int x = 0; x < side; ++x) levels_.back().texels.push_back(map.texel(std::min(x, last), std::min(y, last)));
    while (levels_.back().grid.size() > 1) levels_.push_back(halve(levels_.back(), texel_bytes));
  }

  /// What lies at a receiver's place, moved by an offset, between the texels of a level; the coarsest stands for those
  /// beyond.
  Texel fetch(const Receiver& r, const Offset<T>& offset, int level) const {
    const Level& from = levels_[static_cast<std::size_t>(std::min(level, static_cast<int>(levels_.size()) - 1))];
    const P texels = std::exp2(static_cast<P>(std::countr_zero(static_cast<unsigned>(levels_[0].grid.size())) -
                                              std::countr_zero(static_cast<unsigned>(from.grid.size()))));
    const P px = grid_.position(r.uv.x, offset.x) / texels - P(0.5);
    const P py = grid_.position(r.uv.y, offset.y) / texels - P(0.5);
    const P left = std::floor(px), low = std::floor(py);
    const T sx = sampler_weight<T>(px, left, accuracy_, from.grid.size());
    const T sy = sampler_weight<T>(py, low, accuracy_, from.grid.size());
    const int x = static_cast<int>(left), y = static_cast<int>(low);
    return mix(mix(from.read(x, y), from.read(x + 1, y), sx), mix(from.read(x, y + 1), from.read(x + 1, y + 1), sx),
               sy);
  }

 private:
  struct Level {
    TexelGrid<T> grid;
    std::vector<Texel> texels;

    const Texel& read(int x, int y) const { return texels[*grid.read(x, y)]; }
  };

  TexelGrid<T> grid_;
  GlAccuracy accuracy_;
  std::vector<Level> levels_;

  static Level halve(const Level& finer, int texel_bytes) {
    const auto side = static_cast<std::size_t>(finer.grid.size());
    Level level{TexelGrid<T>(finer.grid.size() / 2, Border::kEdge, texel_bytes), {}};
    for (std::size_t y = 0; y < side; y += 2) {
      for (std::size_t x = 0; x < side; x += 2) {
        const Texel* const four[] = {&finer.texels[y * side + x], &finer.texels[y * side + x + 1],
                                     &finer.texels[(y + 1) * side + x], &finer.texels[(y + 1) * side + x + 1]};
        Texel mean;
        for (std::size_t c = 0; c < N; ++c)
          mean[c] = T(P(0.25)) * ((*four[0])[c] + (*four[1])[c] + (*four[2])[c] + (*four[3])[c]);
        level.texels.push_back(mean);
      }
    }
    return level;
  }
};

}  // namespace shadowbench::filters
