#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <type_traits>
#include <vector>

#include "filters/depth_map.h"
#include "filters/filter_spec.h"
#include "filters/receiver.h"
#include "filters/scalar.h"
#include "filters/store_format.h"

namespace shadowbench::filters {

/// Everything a model may look at besides the receiver.
struct ModelInput {
  const FilterSpec& spec;
  const ParamValues& values;       ///< complete
  const DepthMap& map;             ///< must outlive what is prepared from it
  GlAccuracy accuracy = {};        ///< used by Precision::kTracked only
  std::uint32_t seed = 0;          ///< of the run: rotations
  double plane_max_tangent = 0.0;  ///< with receiver-plane bias: steeper planes are treated as this steep; 0: without
};

/// What happened while one receiver was looked up.
struct Tally {
  bool excused = false;  ///< rounding decided which texel was read, or on which side of a tie a comparison fell
  double disk_radius_texels = 0.0;  ///< of the kernel used here, where kernels differ; see ModelResult
  double screen_value = 0.0;        ///< handed on to screen passes, and a bound on its rounding
  double screen_bound = 0.0;
};

/// A shift in texels.
template <class T>
struct Offset {
  Position<T> x{};
  Position<T> y{};
};

/// A map that lookups read, as it lies in a GPU's memory; its address tells it from others.
struct MapMemory {
  int size = 0;  ///< texels per side
  int texel_bytes = 0;
};

/// A read of a texel that lies in a map.
struct TexelRead {
  const MapMemory* map = nullptr;
  std::size_t texel = 0;  ///< row by row
};

/// Notes which texels lookups in single precision read, on the thread that made it and while it lives. Other precisions
/// tell nothing, and cost no more for it. Requires that a thread has one at a time.
class ReadLog {
 public:
  ReadLog() { current_ = &reads_; }
  ~ReadLog() { current_ = nullptr; }
  ReadLog(const ReadLog&) = delete;
  ReadLog& operator=(const ReadLog&) = delete;

  /// In the order in which they were made, repetitions included.
  const std::vector<TexelRead>& reads() const { return reads_; }
  void clear() { reads_.clear(); }

  /// Whether it hears of the reads of lookups of this arithmetic.
  template <class T>
  static constexpr bool hears = std::is_same_v<T, float>;

  /// For what reads maps.
  static void note(const TexelRead& read) {
    if (current_) current_->push_back(read);
  }

 private:
  inline static constinit thread_local std::vector<TexelRead>* current_ = nullptr;
  std::vector<TexelRead> reads_;
};

/// Turns a receiver's uv and an offset into texel coordinates, rounded as the shaders do it.
template <class T>
class TexelGrid {
 public:
  using P = Position<T>;
  explicit TexelGrid(int size, Border border = Border::kBorder, int texel_bytes = 0)
      : memory_{size, texel_bytes}, border_(border) {}

  int size() const { return memory_.size; }

  /// The index of the texel that a lookup at (x, y) reads; nothing where it reads the border's value.
  std::optional<std::size_t> find(int x, int y) const {
    if (inside(x, y)) return index(x, y);
    switch (border_) {
      case Border::kBorder: return std::nullopt;
      case Border::kEdge: return index(std::clamp(x, 0, size() - 1), std::clamp(y, 0, size() - 1));
      case Border::kRepeat: return index(wrap(x), wrap(y));
    }
    return std::nullopt;
  }

  /// The same for a lookup, whose read is noted.
  std::optional<std::size_t> read(int x, int y) const {
    if constexpr (!ReadLog::hears<T>) return find(x, y);
    const std::optional<std::size_t> found = find(x, y);
    if (found) ReadLog::note({&memory_, *found});
    return found;
  }

  P position(float uv, P offset) const {
    const P size = static_cast<P>(memory_.size);
    return (static_cast<P>(uv) + offset / size) * size;
  }

  /// How far a position lies past the centre of the texel below it: `texel_fraction` of shaders/lib/map_access.glsl.
  P fraction(float uv) const {
    const P past = position(uv, P(0)) - P(0.5);
    return past - std::floor(past);
  }

  /// Finds the texel that holds a position, and excuses positions within 4 ULP of a border.
  int nearest(P position, Tally& tally) const {
    if (std::abs(position - std::round(position)) <= static_cast<P>(border_tolerance())) tally.excused = true;
    return static_cast<int>(std::floor(position));
  }

  /// Four ULP of a coordinate at the far end of the map.
  double border_tolerance() const {
    return 4.0 * static_cast<double>(std::numeric_limits<float>::epsilon()) * 0.5 * static_cast<double>(size());
  }

 private:
  MapMemory memory_;
  Border border_;

  bool inside(int x, int y) const { return x >= 0 && y >= 0 && x < size() && y < size(); }
  std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(size()) + static_cast<std::size_t>(x);
  }
  int wrap(int i) const { return ((i % size()) + size()) % size(); }
};

/// Receiver-plane bias: the receiver plane's depth where texels are read, instead of at the receiver. The same in
/// shaders/lib/map_access.glsl.
class PlaneBias {
 public:
  /// `max_tangent` 0 switches it off.
  explicit PlaneBias(double max_tangent) : max_tangent_(max_tangent) {}

  bool is_on() const { return max_tangent_ > 0.0; }

  /// `at` in texels of the map; the lowest depth within `reach_texels` of it per axis. `z` is the receiver's biased
  /// depth.
  float depth(const Receiver& r, int map_size, glm::dvec2 at, double reach_texels, float z) const {
    if (max_tangent_ <= 0.0) return z;
    const double steepest = max_tangent_ * static_cast<double>(r.texel_size_ws) / static_cast<double>(r.depth_range_ws);
    const glm::dvec2 slope = glm::clamp(glm::dvec2(r.depth_per_texel), -steepest, steepest);
    const double lowest = (reach_texels + kSlackTexels) * (std::abs(slope.x) + std::abs(slope.y));
    const glm::dvec2 way = at - glm::dvec2(r.uv) * static_cast<double>(map_size);
    return static_cast<float>(std::min(static_cast<double>(z) + glm::dot(slope, way) - lowest, 1.0));
  }

 private:
  /// A rasteriser snaps vertices to fractions of a texel, which tilts planes a little.
  static constexpr double kSlackTexels = 1.0 / 128.0;
  double max_tangent_;
};

/// Reads a depth map as `compare_nearest`, `compare_2x2`, `fetch_depth`, `gather_compare` and `gather_depth` of
/// shaders/lib/map_access.glsl do.
/// Outside the map the depth is what its border says: 1, unless the run wants to see an artefact.
template <class T>
class DepthReader {
 public:
  using P = Position<T>;
  explicit DepthReader(const ModelInput& input)
      : grid_(input.map.size, input.map.border, input.map.texel_bytes),
        map_(&input.map),
        accuracy_(input.accuracy),
        plane_(input.plane_max_tangent) {}

  const TexelGrid<T>& grid() const { return grid_; }

  T compare_nearest(const Receiver& r, Offset<T> offset, float z, Tally& tally) const {
    const int x = grid_.nearest(grid_.position(r.uv.x, offset.x), tally);
    const int y = grid_.nearest(grid_.position(r.uv.y, offset.y), tally);
    const float at = plane_.depth(r, grid_.size(), {x + 0.5, y + 0.5}, 0.0, z);
    return T(static_cast<P>(compare(x, y, at, tally)));
  }

  T compare_2x2(const Receiver& r, Offset<T> offset, float z, Tally& tally) const {
    const P px = grid_.position(r.uv.x, offset.x) - P(0.5);
    const P py = grid_.position(r.uv.y, offset.y) - P(0.5);
    const P bx = std::floor(px), by = std::floor(py);
    const int x = static_cast<int>(bx), y = static_cast<int>(by);
    const T sx = sampler_weight<T>(px, bx, accuracy_, grid_.size());
    const T sy = sampler_weight<T>(py, by, accuracy_, grid_.size());
    const float at = plane_.depth(r, grid_.size(), {x + 1.0, y + 1.0}, 0.5, z);
    const auto tap = [&](int dx, int dy) { return T(static_cast<P>(compare(x + dx, y + dy, at, tally))); };
    const T low = mix(tap(0, 0), tap(1, 0), sx);
    const T high = mix(tap(0, 1), tap(1, 1), sx);
    return mix(low, high, sy);
  }

  float fetch_depth(const Receiver& r, Offset<T> offset, Tally& tally) const {
    const int x = grid_.nearest(grid_.position(r.uv.x, offset.x), tally);
    const int y = grid_.nearest(grid_.position(r.uv.y, offset.y), tally);
    return map_->curve.linear(map_->at(grid_.read(x, y)));
  }

  /// The texels that `compare_2x2` reads: upper left, upper right, lower right, lower left. Which ones they are is
  /// excused where rounding decides.
  std::array<T, 4> gather_compare(const Receiver& r, Offset<T> offset, float z, Tally& tally) const {
    const glm::ivec2 low = lower_left(r, offset, tally);
    const float at = plane_.depth(r, grid_.size(), glm::dvec2(low) + 1.0, 0.5, z);
    std::array<T, 4> lit;
    for (std::size_t i = 0; i < 4; ++i)
      lit[i] = T(static_cast<P>(compare(low.x + kGathered[i].x, low.y + kGathered[i].y, at, tally)));
    return lit;
  }

  std::array<float, 4> gather_depth(const Receiver& r, Offset<T> offset, Tally& tally) const {
    const glm::ivec2 low = lower_left(r, offset, tally);
    std::array<float, 4> depths;
    for (std::size_t i = 0; i < 4; ++i)
      depths[i] = map_->curve.linear(map_->at(grid_.read(low.x + kGathered[i].x, low.y + kGathered[i].y)));
    return depths;
  }

  /// `nearest_depth` and `corner_depth` of shaders/lib/map_access.glsl: what `compare_nearest` and `compare_2x2`
  /// compare where they are given `z`.
  float nearest_depth(const Receiver& r, Offset<T> offset, float z, Tally& tally) const {
    const int x = grid_.nearest(grid_.position(r.uv.x, offset.x), tally);
    const int y = grid_.nearest(grid_.position(r.uv.y, offset.y), tally);
    return plane_.depth(r, grid_.size(), {x + 0.5, y + 0.5}, 0.0, z);
  }

  float corner_depth(const Receiver& r, Offset<T> offset, float z, Tally& tally) const {
    return plane_.depth(r, grid_.size(), glm::dvec2(lower_left(r, offset, tally)) + 1.0, 0.5, z);
  }

 private:
  inline static const std::array<glm::ivec2, 4> kGathered{glm::ivec2(0, 1), {1, 1}, {1, 0}, {0, 0}};

  TexelGrid<T> grid_;
  const DepthMap* map_;
  GlAccuracy accuracy_;
  PlaneBias plane_;

  glm::ivec2 lower_left(const Receiver& r, Offset<T> offset, Tally& tally) const {
    return {grid_.nearest(grid_.position(r.uv.x, offset.x) - P(0.5), tally),
            grid_.nearest(grid_.position(r.uv.y, offset.y) - P(0.5), tally)};
  }

  int compare(int x, int y, float z, Tally& tally) const {
    const float stored = map_->at(grid_.read(x, y));
    if (map_->is_tie(z, stored)) tally.excused = true;
    return map_->is_lit(z, stored) ? 1 : 0;
  }
};

}  // namespace shadowbench::filters
