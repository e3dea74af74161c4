#pragma once

#include <cstdint>
#include <functional>
#include <glm/glm.hpp>
#include <vector>

#include "reference/truth/occluders.h"

namespace shadowbench::truth {

/// The number of independent scrambles; a standard error over them has one degree of freedom less.
inline constexpr int kScrambles = RayPacket::kSize;

/// Low-discrepancy points, mapped once to where rays go: 16 randomisations, of which each pixel takes one by a hash of
/// its place, each with 16 independent scrambles side by side as the lanes of a packet.
///
/// Each scramble is a Sobol sequence of its own Owen scrambling; the randomisations differ by digital shifts, which
/// keep it uniform. The first 4^k points of a scramble are evenly spread.
class SampleSets {
 public:
  static constexpr int kSets = 16;

  /// Maps two independent points of [0,1)^2 to an offset.
  using Mapping = std::function<glm::dvec2(const glm::dvec2& first, const glm::dvec2& second)>;

  /// One point of every scramble.
  struct Lanes {
    alignas(64) RayPacket::Lanes x;
    alignas(64) RayPacket::Lanes y;
  };

  /// Cost: 16 * 16 * `max_points` mappings, 128 bytes for every 16 of them.
  SampleSets(int max_points, std::uint32_t seed, const Mapping& mapping);

  const Lanes& at(int set, int point) const {
    return lanes_[static_cast<std::size_t>(set) * static_cast<std::size_t>(max_points_) +
                  static_cast<std::size_t>(point)];
  }

  int max_points() const { return max_points_; }

 private:
  int max_points_;
  std::vector<Lanes> lanes_;  ///< set by set
};

}  // namespace shadowbench::truth
