#pragma once

#include <glm/glm.hpp>

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace shadowbench::reference {

/// Triangles that block light, both faces; world space, metres.
struct OccluderMesh {
  std::vector<glm::vec3> positions;
  std::vector<std::uint32_t> indices;  ///< three per triangle, all < positions.size()
};

/// Sixteen rays, traced together.
struct RayPacket {
  static constexpr int kSize = 16;
  std::array<glm::vec3, kSize> origins;
  std::array<glm::vec3, kSize> directions;  ///< need not be of unit length
  float reach = 0.0f;                       ///< in units of a direction's length; infinity for lights at infinity
  int count = 0;                            ///< the first so many are traced
};

/// A scene to trace shadow rays in.
class Occluders {
 public:
  /// Builds the acceleration structure; degenerate triangles are dropped, since they may misreport.
  /// Cost: about a second per million triangles.
  explicit Occluders(std::span<const OccluderMesh> meshes);
  ~Occluders();
  Occluders(Occluders&&) noexcept;
  Occluders& operator=(Occluders&&) noexcept;

  /// Says for each ray of a packet whether anything blocks it, as bits: bit i belongs to ray i. Safe to call from many
  /// threads.
  std::uint32_t find_blocked(const RayPacket& packet) const;

  /// Moves a point off its surface, along the geometric normal towards the viewer, by a bound on the error that single
  /// precision may have left in it: of its own coordinates and of the scene's largest ones, which interpolation mixed.
  /// Source: Pharr, Jakob and Humphreys 2016, Physically Based Rendering, 3rd ed., section 3.9.
  glm::vec3 offset_origin(const glm::vec3& position, const glm::vec3& normal) const;

  std::int64_t triangle_count() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace shadowbench::reference
