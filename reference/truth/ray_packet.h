#pragma once

#include <glm/glm.hpp>

#include <array>
#include <cstdint>

namespace shadowbench::reference {

/// Sixteen rays, traced together; world space.
struct RayPacket {
  static constexpr int kSize = 16;
  using Lanes = std::array<float, kSize>;

  alignas(64) std::array<Lanes, 3> origin;     ///< x, y, z
  alignas(64) std::array<Lanes, 3> direction;  ///< x, y, z; need not be of unit length
  float reach = 0.0f;                          ///< in units of a direction's length; infinity for lights at infinity
  std::uint32_t active = 0;                    ///< bit i: ray i is traced

  /// Sets a ray and makes it active.
  void set(int lane, const glm::vec3& from, const glm::vec3& towards) {
    for (int axis = 0; axis < 3; ++axis) {
      origin[static_cast<std::size_t>(axis)][static_cast<std::size_t>(lane)] = from[axis];
      direction[static_cast<std::size_t>(axis)][static_cast<std::size_t>(lane)] = towards[axis];
    }
    active |= 1u << lane;
  }
};

}  // namespace shadowbench::reference
