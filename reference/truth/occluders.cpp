#include "reference/truth/occluders.h"

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <new>
#include <stdexcept>
#include <string>

#include "reference/truth/embree.h"

namespace shadowbench::truth {

/// What surfaces that dim have left of each ray of a packet. Embree may report one hit several times, and a ray through
/// an edge hits both triangles there: crossings of one mesh, to the same side, within `same_m` of each other are one.
class Dimming {
 public:
  Dimming(RayPacket::Lanes& transmittance, float same_m) : transmittance_(transmittance), same_m_(same_m) {}

  /// Dims the ray of a lane, and returns what is left. `surface` tells meshes and their sides apart. The latest 16
  /// crossings of a ray are remembered.
  float cross(std::size_t lane, std::uint32_t surface, float distance_m, float alpha) {
    std::array<Crossing, kRemembered>& known = known_[lane];
    const std::uint32_t last = std::min(counts_[lane], kRemembered);
    const auto is_same = [&](const Crossing& each) {
      return each.surface == surface && std::abs(each.distance_m - distance_m) <= same_m_;
    };
    if (std::any_of(known.begin(), known.begin() + last, is_same)) return transmittance_[lane];
    known[counts_[lane]++ % kRemembered] = {surface, distance_m};
    return transmittance_[lane] *= 1.0f - alpha;
  }

 private:
  static constexpr std::uint32_t kRemembered = 16;
  struct Crossing {
    std::uint32_t surface;
    float distance_m;
  };
  RayPacket::Lanes& transmittance_;
  float same_m_;
  RayPacket::Words counts_{};
  std::array<std::array<Crossing, kRemembered>, RayPacket::kSize> known_;
};

namespace {

int wrap(int i, int size) { return ((i % size) + size) % size; }

/// Bilinear, repeated, texel centres at .5; in [0,1].
float read_alpha(const CutOut& cut_out, glm::vec2 uv) {
  if (cut_out.width == 0) return 1.0f;
  const glm::vec2 at = uv * glm::vec2(cut_out.width, cut_out.height) - 0.5f;
  const glm::vec2 base = glm::floor(at), weight = at - base;
  const auto texel = [&](int dx, int dy) {
    const int x = wrap(static_cast<int>(base.x) + dx, cut_out.width),
              y = wrap(static_cast<int>(base.y) + dy, cut_out.height);
    return static_cast<float>(cut_out.alpha[static_cast<std::size_t>(y * cut_out.width + x)]) / 255.0f;
  };
  const float low = glm::mix(texel(0, 0), texel(1, 0), weight.x), high = glm::mix(texel(0, 1), texel(1, 1), weight.x);
  return glm::mix(low, high, weight.y);
}

/// Of the largest coordinates: see origin_offset().
constexpr float kRoundings = 16.0f;

std::vector<std::uint32_t> keep_triangles_with_area(const OccluderMesh& mesh) {
  std::vector<std::uint32_t> kept;
  for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
    const std::uint32_t* corner = &mesh.indices[i];
    const glm::dvec3 a(mesh.positions[corner[0]]), b(mesh.positions[corner[1]]), c(mesh.positions[corner[2]]);
    const glm::dvec3 normal = glm::cross(b - a, c - a);
    if (glm::dot(normal, normal) > 0.0) kept.insert(kept.end(), corner, corner + 3);
  }
  return kept;
}

// A packet is handed to Embree as it is.
static_assert(sizeof(RTCRay16) == offsetof(RayPacket, active));
static_assert(offsetof(RTCRay16, dir_x) == offsetof(RayPacket, direction));
static_assert(offsetof(RTCRay16, tfar) == offsetof(RayPacket, reach));
static_assert(offsetof(RTCRay16, mask) == offsetof(RayPacket, mask));

/// Rejects hits that lie in holes, as a filter function of Embree. The geometry's user data must be a HoleTest.
void forgive_holes(const RTCFilterFunctionNArguments* arguments) {
  const auto& test = *static_cast<const HoleTest*>(arguments->geometryUserPtr);
  for (unsigned i = 0; i < arguments->N; ++i) {
    if (arguments->valid[i] == 0) continue;
    const unsigned triangle = RTCHitN_primID(arguments->hit, arguments->N, i);
    const float u = RTCHitN_u(arguments->hit, arguments->N, i), v = RTCHitN_v(arguments->hit, arguments->N, i);
    if (test.is_hole(triangle, u, v)) arguments->valid[i] = 0;
  }
}

/// Rejects hits, but what they leave of the ray is kept, until that is nothing. As forgive_holes(); the context must be
/// an OcclusionContext.
void dim_rays(const RTCFilterFunctionNArguments* arguments) {
  const auto& test = *static_cast<const HoleTest*>(arguments->geometryUserPtr);
  Dimming& dimming = *static_cast<const OcclusionContext*>(arguments->context)->dimming;
  RTCRayN* rays = arguments->ray;
  RTCHitN* hits = arguments->hit;
  const unsigned n = arguments->N;
  for (unsigned i = 0; i < n; ++i) {
    if (arguments->valid[i] == 0) continue;
    const glm::vec3 way(RTCRayN_dir_x(rays, n, i), RTCRayN_dir_y(rays, n, i), RTCRayN_dir_z(rays, n, i));
    const glm::vec3 normal(RTCHitN_Ng_x(hits, n, i), RTCHitN_Ng_y(hits, n, i), RTCHitN_Ng_z(hits, n, i));
    const unsigned surface = 2 * RTCHitN_geomID(hits, n, i) + (glm::dot(way, normal) > 0.0f ? 1 : 0);
    const float alpha = test.find_alpha(RTCHitN_primID(hits, n, i), RTCHitN_u(hits, n, i), RTCHitN_v(hits, n, i));
    const float left =
        dimming.cross(RTCRayN_id(rays, n, i), surface, RTCRayN_tfar(rays, n, i) * glm::length(way), alpha);
    if (left > 0.0f) arguments->valid[i] = 0;
  }
}

}  // namespace

float origin_offset(float largest_coordinate, float largest_of_scene) {
  return kRoundings * 0x1p-24f * (largest_coordinate + largest_of_scene);
}

struct Occluders::Impl {
  RTCDevice device = rtcNewDevice(nullptr);
  RTCScene scene = rtcNewScene(device);
  glm::vec3 largest{0.0f};  ///< largest coordinate per axis, by magnitude
  std::int64_t triangles = 0;
  bool any_dims = false;  ///< whether a surface only dims rays
  std::vector<std::unique_ptr<HoleTest>> hole_tests;

  Impl() = default;
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;
  ~Impl() {
    rtcReleaseScene(scene);
    rtcReleaseDevice(device);
  }

  /// Embree reports a failure by a null pointer and an error code of the device; if they went unchecked, rays would
  /// miss everything. Throws std::bad_alloc, or std::runtime_error for any other failure.
  void require(bool is_done) const {
    const RTCError error = rtcGetDeviceError(device);
    if (error == RTC_ERROR_OUT_OF_MEMORY || (!is_done && error == RTC_ERROR_NONE)) throw std::bad_alloc();
    if (error != RTC_ERROR_NONE)
      throw std::runtime_error("Embree cannot take the scene: error " + std::to_string(error));
  }

  void add(const OccluderMesh& mesh) {
    std::vector<std::uint32_t> indices = keep_triangles_with_area(mesh);
    triangles += static_cast<std::int64_t>(indices.size() / 3);
    if (indices.empty()) return;
    const std::unique_ptr<RTCGeometryTy, decltype(&rtcReleaseGeometry)> owned(
        rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE), &rtcReleaseGeometry);
    RTCGeometry geometry = owned.get();
    require(geometry != nullptr);
    void* vertices = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, sizeof(glm::vec3),
                                             mesh.positions.size());
    require(vertices != nullptr);
    std::copy(mesh.positions.begin(), mesh.positions.end(), static_cast<glm::vec3*>(vertices));
    void* corners = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                            3 * sizeof(std::uint32_t), indices.size() / 3);
    require(corners != nullptr);
    std::copy(indices.begin(), indices.end(), static_cast<std::uint32_t*>(corners));
    if (mesh.cut_out) {
      hole_tests.push_back(std::make_unique<HoleTest>(HoleTest{*mesh.cut_out, std::move(indices)}));
      rtcSetGeometryUserData(geometry, hole_tests.back().get());
      const bool dims = mesh.cut_out->dims;  // such a surface is met where its first hit is
      any_dims = any_dims || dims;
      rtcSetGeometryOccludedFilterFunction(geometry, dims ? &dim_rays : &forgive_holes);
      if (!dims) rtcSetGeometryIntersectFilterFunction(geometry, &forgive_holes);
    }
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene, geometry);
    for (const glm::vec3& p : mesh.positions) largest = glm::max(largest, glm::abs(p));
  }
};

Occluders::Occluders(std::span<const OccluderMesh> meshes) : impl_(std::make_unique<Impl>()) {
  impl_->require(impl_->device != nullptr && impl_->scene != nullptr);
  // Robust: no ray slips through a shared edge. High quality: far more time goes into tracing than into building.
  rtcSetSceneFlags(impl_->scene, RTC_SCENE_FLAG_ROBUST);
  rtcSetSceneBuildQuality(impl_->scene, RTC_BUILD_QUALITY_HIGH);
  for (const OccluderMesh& mesh : meshes) impl_->add(mesh);
  rtcCommitScene(impl_->scene);
  impl_->require(true);
}

Occluders::~Occluders() = default;
Occluders::Occluders(Occluders&&) noexcept = default;
Occluders& Occluders::operator=(Occluders&&) noexcept = default;

void Occluders::find_blocked(RayPacket& packet) const {
  const float largest = std::max({impl_->largest.x, impl_->largest.y, impl_->largest.z});
  packet.transmittance.fill(1.0f);
  Dimming dimming(packet.transmittance, origin_offset(largest, largest));
  occlude_packet(packet.active.data(), impl_->scene, reinterpret_cast<RTCRay16*>(&packet),
                 impl_->any_dims ? &dimming : nullptr);
  for (std::size_t i = 0; i < packet.transmittance.size(); ++i)
    packet.transmittance[i] = packet.reach[i] < 0.0f ? 0.0f : packet.transmittance[i];
}

PacketHits Occluders::find_nearest(const RayPacket& packet) const {
  RTCRayHit16 hits;
  std::memcpy(&hits.ray, &packet, sizeof(hits.ray));
  std::fill(std::begin(hits.hit.geomID), std::end(hits.hit.geomID), RTC_INVALID_GEOMETRY_ID);
  intersect_packet(packet.active.data(), impl_->scene, &hits);
  PacketHits result;
  for (std::size_t i = 0; i < RayPacket::kSize; ++i) {
    const bool is_hit = packet.active[i] != 0 && hits.hit.geomID[i] != RTC_INVALID_GEOMETRY_ID;
    result.distances[i] = is_hit ? hits.ray.tfar[i] : std::numeric_limits<float>::infinity();
    if (!is_hit) continue;
    result.normals[0][i] = hits.hit.Ng_x[i];
    result.normals[1][i] = hits.hit.Ng_y[i];
    result.normals[2][i] = hits.hit.Ng_z[i];
  }
  return result;
}

glm::vec3 Occluders::offset_origin(const glm::vec3& position, const glm::vec3& normal, float extent) const {
  // One bound for all axes: a coordinate that is 0 everywhere would leave the point on its surface.
  const auto largest = [](const glm::vec3& v) { return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)}); };
  const float error = origin_offset(largest(position) + extent, largest(impl_->largest));
  glm::vec3 moved = position + normal * error;
  // The sum itself is rounded: one step further, away from the surface.
  for (int axis = 0; axis < 3; ++axis) {
    if (normal[axis] > 0.0f) moved[axis] = std::nextafter(moved[axis], HUGE_VALF);
    if (normal[axis] < 0.0f) moved[axis] = std::nextafter(moved[axis], -HUGE_VALF);
  }
  return moved;
}

std::int64_t Occluders::triangle_count() const { return impl_->triangles; }
float Occluders::farthest() const { return glm::length(impl_->largest); }

Box Occluders::bounds() const {
  RTCBounds bounds;
  rtcGetSceneBounds(impl_->scene, &bounds);
  return {{bounds.lower_x, bounds.lower_y, bounds.lower_z}, {bounds.upper_x, bounds.upper_y, bounds.upper_z}};
}

float HoleTest::find_alpha(std::uint32_t triangle, float u, float v) const {
  const std::uint32_t* corner = &indices[3 * static_cast<std::size_t>(triangle)];
  const glm::vec2 uv =
      (1.0f - u - v) * cut_out.uvs[corner[0]] + u * cut_out.uvs[corner[1]] + v * cut_out.uvs[corner[2]];
  return cut_out.base_alpha * read_alpha(cut_out, uv);
}

bool HoleTest::is_hole(std::uint32_t triangle, float u, float v) const {
  return find_alpha(triangle, u, v) < cut_out.cutoff;
}

}  // namespace shadowbench::truth
