#include "harness/scene/shadow_edges.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "harness/scene/scene.h"
#include "harness/scene/view_clip.h"
#include "reference/truth/visibility.h"

namespace shadowbench::scene {
namespace {

constexpr double kFewestSurfaces = 0.5;  ///< of the pixels

/// The rays of a camera's pixels, row by row from the top.
std::vector<SceneRay> make_rays(const Camera& camera, int width, int height) {
  const ViewAxes view(camera);
  const bool is_flat = view.half_height > 0.0;
  const double step = 2.0 * (is_flat ? view.half_height : view.tangent) / height;
  std::vector<SceneRay> rays;
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const glm::dvec3 across = step * ((x + 0.5 - 0.5 * width) * view.right + (0.5 * height - y - 0.5) * view.up);
      rays.push_back(is_flat ? SceneRay{view.eye + across, view.forward} : SceneRay{view.eye, view.forward + across});
    }
  }
  return rays;
}

/// What a ray meets, with the normal turned against the ray.
truth::ReceiverPoint make_receiver(const SceneRay& ray, float distance, const glm::dvec3& normal) {
  const glm::dvec3 towards_viewer = glm::normalize(glm::dot(normal, ray.direction) > 0.0 ? -normal : normal);
  constexpr double kBefore = 1.0 - 0x1p-22;  // of a distance in single precision: not behind the surface
  return {ray.origin + ray.direction * (kBefore * static_cast<double>(distance)), towards_viewer, true};
}

/// Whether two receivers lie on one smooth surface.
bool is_same_surface(const truth::ReceiverPoint& a, const truth::ReceiverPoint& b) {
  constexpr float kLeastCosine = 0.9f;
  constexpr float kSteepest = 0.25f;
  if (!a.counts || !b.counts || glm::dot(a.normal_ws, b.normal_ws) < kLeastCosine) return false;
  const glm::vec3 between = b.position_ws - a.position_ws;
  const float rise = std::max(std::abs(glm::dot(a.normal_ws, between)), std::abs(glm::dot(b.normal_ws, between)));
  return rise <= kSteepest * glm::length(between);
}

}  // namespace

double EdgeCount::share() const {
  return pixels > 0 ? at_edge / std::max<double>(surfaces, kFewestSurfaces * pixels) : 0.0;
}

EdgeCount& EdgeCount::operator+=(const EdgeCount& other) {
  pixels += other.pixels;
  surfaces += other.surfaces;
  lit += other.lit;
  at_edge += other.at_edge;
  return *this;
}

EdgeMeter::EdgeMeter(const Scene& scene) {
  for (const bool casts_shadow : {true, false}) {
    const std::vector<truth::OccluderMesh> meshes = list_occluders(scene, casts_shadow);
    if (!meshes.empty()) parts_.push_back({truth::Occluders(meshes), casts_shadow});
  }
}

void EdgeMeter::set_floor(const Mesh* floor) {
  floor_.reset();
  if (!floor) return;
  truth::OccluderMesh mesh;
  for (const Vertex& vertex : floor->vertices) mesh.positions.push_back(vertex.position_ws);
  mesh.indices = floor->indices;
  floor_.emplace(Part{truth::Occluders(std::span(&mesh, 1)), true});
}

std::vector<const EdgeMeter::Part*> EdgeMeter::parts() const {
  std::vector<const Part*> all;
  for (const Part& part : parts_) all.push_back(&part);
  if (floor_) all.push_back(&*floor_);
  return all;
}

std::vector<truth::ReceiverPoint> EdgeMeter::trace(std::span<const SceneRay> rays) const {
  std::vector<truth::ReceiverPoint> points(rays.size());
  for (std::size_t first = 0; first < rays.size(); first += truth::RayPacket::kSize) {
    const std::size_t lanes = std::min<std::size_t>(truth::RayPacket::kSize, rays.size() - first);
    truth::RayPacket packet;
    for (std::size_t lane = 0; lane < lanes; ++lane)
      packet.set(lane, rays[first + lane].origin, rays[first + lane].direction);
    for (const Part* part : parts()) {
      const truth::PacketHits hits = part->surfaces.find_nearest(packet);
      for (std::size_t lane = 0; lane < lanes; ++lane) {
        if (!(hits.distances[lane] < packet.reach[lane])) continue;
        packet.reach[lane] = hits.distances[lane];
        points[first + lane] = make_receiver(rays[first + lane], hits.distances[lane], hits.normal(lane));
      }
    }
  }
  return points;
}

std::vector<glm::vec3> EdgeMeter::find_lit_points(const Beam& lamp) const {
  constexpr int kRays = 2048;
  std::vector<SceneRay> rays;
  for (int i = 0; i < kRays; ++i) {  // evenly over the sphere, along a spiral of golden angles
    const double y = 1.0 - (2.0 * i + 1.0) / kRays, across = std::sqrt(1.0 - y * y);
    const double angle = i * std::numbers::pi * (3.0 - std::sqrt(5.0));
    const glm::dvec3 direction(across * std::cos(angle), y, across * std::sin(angle));
    if (lamp.cone_at(lamp.position_ws + direction) > 0.0) rays.push_back({lamp.position_ws, direction});
  }
  std::vector<glm::vec3> points;
  for (const truth::ReceiverPoint& each : trace(rays))
    if (each.counts) points.push_back(each.position_ws);
  const auto distance = [&](const glm::vec3& point) { return glm::distance(glm::vec3(lamp.position_ws), point); };
  std::ranges::sort(points, {}, distance);
  if (points.empty()) return points;
  const float reach = 2.0f * distance(points[points.size() / 2]);
  std::erase_if(points, [&](const glm::vec3& point) { return distance(point) > reach; });
  return points;
}

EdgeCount EdgeMeter::count(const Camera& camera, const Light& light, double aspect, int width) const {
  const int height = std::clamp(static_cast<int>(std::lround(width / aspect)), 1, 8 * width);
  truth::ReceiverImage seen{width, height, trace(make_rays(camera, width, height))};
  EdgeCount result;
  result.pixels = static_cast<int>(seen.points.size());
  result.surfaces = static_cast<int>(std::ranges::count(seen.points, true, &truth::ReceiverPoint::counts));
  for (truth::ReceiverPoint& point : seen.points) {
    point.counts = point.counts && glm::dot(point.normal_ws, to_light(light, point.position_ws)) > 0.0f &&
                   shines_on(light, point.position_ws);
  }
  std::vector<float> visibility(seen.points.size(), 1.0f);
  for (const Part* part : parts()) {
    if (!part->casts_shadow) continue;
    const std::vector<float> unblocked = truth::trace_hard(part->surfaces, seen, make_area_light(light));
    std::ranges::transform(visibility, unblocked, visibility.begin(), [](float a, float b) { return std::min(a, b); });
  }
  std::vector<bool> at_edge(seen.points.size());
  const auto compare = [&](std::size_t a, std::size_t b) {
    if (visibility[a] == visibility[b] || !is_same_surface(seen.points[a], seen.points[b])) return;
    at_edge[a] = at_edge[b] = true;
  };
  const auto across = static_cast<std::size_t>(width);
  for (std::size_t i = 0; i < seen.points.size(); ++i) {
    result.lit += seen.points[i].counts && visibility[i] > 0.0f;
    if ((i + 1) % across != 0) compare(i, i + 1);
    if (i + across < seen.points.size()) compare(i, i + across);
  }
  result.at_edge = static_cast<int>(std::ranges::count(at_edge, true));
  return result;
}

}  // namespace shadowbench::scene
