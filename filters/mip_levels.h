#pragma once

#include <bit>

#include "filters/encoded_map.h"

namespace shadowbench::filters {

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
