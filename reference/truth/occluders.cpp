#include "reference/truth/occluders.h"

#include <embree3/rtcore.h>

#include <algorithm>
#include <cassert>
#include <cmath>

namespace shadowbench::reference {
namespace {

/// Roundings of a point that was interpolated from its triangle's corners, in units of the largest coordinate.
constexpr float kRoundings = 16.0f;

bool has_area(const glm::vec3& a, const glm::vec3& b, const glm::vec3& c) {
  const glm::dvec3 normal = glm::cross(glm::dvec3(b) - glm::dvec3(a), glm::dvec3(c) - glm::dvec3(a));
  return glm::dot(normal, normal) > 0.0;
}

std::vector<std::uint32_t> keep_triangles_with_area(const OccluderMesh& mesh) {
  std::vector<std::uint32_t> kept;
  for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
    const std::uint32_t a = mesh.indices[i], b = mesh.indices[i + 1], c = mesh.indices[i + 2];
    if (has_area(mesh.positions[a], mesh.positions[b], mesh.positions[c])) kept.insert(kept.end(), {a, b, c});
  }
  return kept;
}

}  // namespace

struct Occluders::Impl {
  RTCDevice device = rtcNewDevice(nullptr);
  RTCScene scene = rtcNewScene(device);
  glm::vec3 largest{0.0f};  ///< largest coordinate per axis, by magnitude
  std::int64_t triangles = 0;

  Impl() = default;
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;
  ~Impl() {
    rtcReleaseScene(scene);
    rtcReleaseDevice(device);
  }

  void add(const OccluderMesh& mesh) {
    const std::vector<std::uint32_t> indices = keep_triangles_with_area(mesh);
    if (indices.empty()) return;
    RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
    void* vertices = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, sizeof(glm::vec3),
                                             mesh.positions.size());
    std::copy(mesh.positions.begin(), mesh.positions.end(), static_cast<glm::vec3*>(vertices));
    void* corners = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                            3 * sizeof(std::uint32_t), indices.size() / 3);
    std::copy(indices.begin(), indices.end(), static_cast<std::uint32_t*>(corners));
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene, geometry);
    rtcReleaseGeometry(geometry);
    triangles += static_cast<std::int64_t>(indices.size() / 3);
    for (const glm::vec3& p : mesh.positions) largest = glm::max(largest, glm::abs(p));
  }
};

Occluders::Occluders(std::span<const OccluderMesh> meshes) : impl_(std::make_unique<Impl>()) {
  // Robust: no ray slips through a shared edge. High quality: many more rays are traced than triangles are built in.
  rtcSetSceneFlags(impl_->scene, RTC_SCENE_FLAG_ROBUST);
  rtcSetSceneBuildQuality(impl_->scene, RTC_BUILD_QUALITY_HIGH);
  for (const OccluderMesh& mesh : meshes) impl_->add(mesh);
  rtcCommitScene(impl_->scene);
}

Occluders::~Occluders() = default;
Occluders::Occluders(Occluders&&) noexcept = default;
Occluders& Occluders::operator=(Occluders&&) noexcept = default;

std::uint32_t Occluders::find_blocked(const RayPacket& packet) const {
  assert(packet.count <= RayPacket::kSize);
  RTCRay16 rays;
  alignas(64) int valid[RayPacket::kSize];
  for (int i = 0; i < RayPacket::kSize; ++i) {
    const auto k = static_cast<std::size_t>(std::min(i, std::max(packet.count - 1, 0)));
    valid[i] = i < packet.count ? -1 : 0;
    rays.org_x[i] = packet.origins[k].x;
    rays.org_y[i] = packet.origins[k].y;
    rays.org_z[i] = packet.origins[k].z;
    rays.dir_x[i] = packet.directions[k].x;
    rays.dir_y[i] = packet.directions[k].y;
    rays.dir_z[i] = packet.directions[k].z;
    rays.tnear[i] = 0.0f;
    rays.tfar[i] = packet.reach;
    rays.time[i] = 0.0f;
    rays.mask[i] = 0xffffffffu;
    rays.id[i] = 0;
    rays.flags[i] = 0;
  }
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  rtcOccluded16(valid, impl_->scene, &context, &rays);
  std::uint32_t blocked = 0;
  for (int i = 0; i < packet.count; ++i) {
    if (rays.tfar[i] < 0.0f) blocked |= 1u << i;  // Embree marks a hit with -inf
  }
  return blocked;
}

glm::vec3 Occluders::offset_origin(const glm::vec3& position, const glm::vec3& normal) const {
  // One bound for all axes: a coordinate that is 0 everywhere would leave the point on its surface.
  const auto largest = [](const glm::vec3& v) { return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)}); };
  const float error = kRoundings * 0x1p-24f * (largest(position) + largest(impl_->largest));
  glm::vec3 moved = position + normal * error;
  // The sum itself is rounded: one step further, away from the surface.
  for (int axis = 0; axis < 3; ++axis) {
    if (normal[axis] > 0.0f) moved[axis] = std::nextafter(moved[axis], HUGE_VALF);
    if (normal[axis] < 0.0f) moved[axis] = std::nextafter(moved[axis], -HUGE_VALF);
  }
  return moved;
}

std::int64_t Occluders::triangle_count() const { return impl_->triangles; }

}  // namespace shadowbench::reference
