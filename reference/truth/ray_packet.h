#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <glm/glm.hpp>
#include <limits>

namespace shadowbench::truth {

/// Sixteen rays, traced together; world space. The fields before `active` lie as Embree wants them.
struct alignas(64) RayPacket {
  static constexpr int kSize = 16;
  using Lanes = std::array<float, kSize>;
  using Words = std::array<std::uint32_t, kSize>;

  std::array<Lanes, 3> origin{};     ///< x, y, z
  Lanes nearest{};                   ///< 0
  std::array<Lanes, 3> direction{};  ///< x, y, z; need not be of unit length
  Lanes time{};
  Lanes reach{};  ///< in units of a direction's length; infinity for lights at infinity
  Words mask = every(0xffffffffu);
  Words id{};
  Words flags{};
  alignas(64) std::array<std::int32_t, kSize> active{};  ///< -1: traced, 0: not

  template <class T>
  static constexpr std::array<T, kSize> every(T value) {
    std::array<T, kSize> lanes{};
    lanes.fill(value);
    return lanes;
  }

  /// Sets a ray and makes it active, unless it is not finite or beyond 1e18 m, which Embree does not take.
  void set(std::size_t lane, const glm::vec3& from, const glm::vec3& towards,
           float length = std::numeric_limits<float>::infinity()) {
    constexpr float kFarthest = 1e18f;
    bool is_taken = true;
    for (int axis = 0; axis < 3; ++axis) {
      is_taken = is_taken && std::abs(from[axis]) < kFarthest && std::abs(towards[axis]) < kFarthest;
      origin[static_cast<std::size_t>(axis)][lane] = from[axis];
      direction[static_cast<std::size_t>(axis)][lane] = towards[axis];
    }
    reach[lane] = length;
    active[lane] = is_taken ? -1 : 0;
  }
};

}  // namespace shadowbench::truth
