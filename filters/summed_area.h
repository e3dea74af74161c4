#pragma once

#include <bit>

#include "filters/encoded_map.h"
#include "filters/model.h"

namespace shadowbench::filters {

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
