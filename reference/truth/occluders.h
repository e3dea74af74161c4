#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <glm/glm.hpp>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <vector>

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
  Words id = number_lanes();
  Words flags{};
  alignas(64) std::array<std::int32_t, kSize> active{};  ///< -1: traced, 0: not
  Lanes transmittance{};  ///< set by Occluders::find_blocked(): the share of the light that a traced ray lets arrive

  template <class T>
  static constexpr std::array<T, kSize> every(T value) {
    std::array<T, kSize> lanes{};
    lanes.fill(value);
    return lanes;
  }

  static constexpr Words number_lanes() {
    Words lanes{};
    for (std::uint32_t lane = 0; lane < kSize; ++lane) lanes[lane] = lane;
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

/// Where a mesh has holes: a ray passes where the alpha of its texture is under the cutoff. A mesh that dims has none:
/// each crossing leaves 1 - alpha of a ray. The texture repeats and is read bilinearly, its first row at v = 0. The
/// depth pass discards by the same rule, but reads a smaller mip level where the map has fewer texels than the texture:
/// fine holes can be lost there, which is the map's error.
struct CutOut {
  std::vector<glm::vec2> uvs;  ///< one per position
  int width = 0;               ///< of the texture; 0: none, alpha is `base_alpha` everywhere
  int height = 0;
  std::vector<std::uint8_t> alpha;  ///< width * height
  float base_alpha = 1.0f;          ///< factor
  float cutoff = 0.5f;
  bool dims = false;
};

/// Triangles that block light, both faces; world space, metres.
struct OccluderMesh {
  std::vector<glm::vec3> positions;
  std::vector<std::uint32_t> indices;  ///< three per triangle, all < positions.size()
  std::optional<CutOut> cut_out;
};

/// Finds the alpha of hits on a mesh, and which of them lie in its holes.
struct HoleTest {
  CutOut cut_out;
  std::vector<std::uint32_t> indices;  ///< three per triangle that is traced

  /// The alpha of a point of a triangle, given by the weights of its second and third corner.
  float find_alpha(std::uint32_t triangle, float u, float v) const;

  /// Whether that point is a hole.
  bool is_hole(std::uint32_t triangle, float u, float v) const;
};

/// An axis-aligned box; empty while min > max.
struct Box {
  glm::vec3 min{1.0f};
  glm::vec3 max{-1.0f};
};

/// How far off a surface rays start, from the largest coordinates of the point, P, and of its scene, S. All in metres.
///
/// With roundings of u = 2^-24 it is 16 u (P + S). A receiver lies within 8 u P of a point that shaders/gbuffer.frag
/// makes of its triangle's corners: one of them, plus shares of two edges. On each axis these are 2 S at most, with
/// three roundings, and the sum is P with one: sqrt(3) u (P + 6 S) in any direction. What is left, u (6 P + 5 S), is
/// for the roundings of a ray that is tested against the triangle.
float origin_offset(float largest_coordinate, float largest_of_scene);

/// What the rays of a packet meet first.
struct PacketHits {
  RayPacket::Lanes distances{};               ///< in units of a direction's length; infinity where nothing is hit
  std::array<RayPacket::Lanes, 3> normals{};  ///< x, y, z of the triangle's normal: of any length, to either side

  glm::vec3 normal(std::size_t lane) const { return {normals[0][lane], normals[1][lane], normals[2][lane]}; }
};

/// A scene to trace shadow rays in.
class Occluders {
 public:
  /// Builds the acceleration structure; degenerate triangles are dropped, since they may misreport.
  /// Throws std::bad_alloc where memory runs out.
  /// Cost: about a second per million triangles.
  explicit Occluders(std::span<const OccluderMesh> meshes);
  ~Occluders();
  Occluders(Occluders&&) noexcept;
  Occluders& operator=(Occluders&&) noexcept;

  /// Finds the `transmittance` of each active ray: 0 where anything blocks it, else the product of what each surface
  /// that dims leaves of it. Safe to call from many threads.
  void find_blocked(RayPacket& packet) const;

  /// For each active ray how far it gets, and what it meets there. Safe to call from many threads.
  PacketHits find_nearest(const RayPacket& packet) const;

  /// Moves a point off its surface, along the geometric normal towards the viewer, by a bound on its rounding error.
  /// The bound grows with the point's coordinates, with the largest ones of the scene, and with `extent`: the length in
  /// metres of steps that are then taken from the point along the surface. Source: Pharr, Jakob and Humphreys 2016,
  /// Physically Based Rendering, 3rd ed., section 3.9.
  glm::vec3 offset_origin(const glm::vec3& position, const glm::vec3& normal, float extent = 0.0f) const;

  std::int64_t triangle_count() const;  ///< without the degenerate ones
  Box bounds() const;                   ///< of what is traced

  /// The distance from the origin within which everything lies, metres.
  float farthest() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace shadowbench::truth
