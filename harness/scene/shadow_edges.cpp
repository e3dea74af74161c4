#include "harness/scene/shadow_edges.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <utility>

#include "harness/scene/lights/light_fit.h"
#include "harness/scene/scene.h"
#include "reference/truth/visibility.h"

namespace shadowbench::scene {
namespace {

constexpr int kFineWidth = 240;
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

truth::ReceiverImage EdgeMeter::look(const Camera& camera, double aspect, int width) const {
  const int height = std::clamp(static_cast<int>(std::lround(width / aspect)), 1, 8 * width);
  return {width, height, trace(make_rays(camera, width, height))};
}

/// Receivers that the light does not shine on no longer count afterwards.
EdgeMeter::Edges EdgeMeter::find_edges(truth::ReceiverImage& seen, const Light& light) const {
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
  Edges edges{std::vector<bool>(seen.points.size()), std::vector<bool>(seen.points.size()), 0};
  const auto compare = [&](std::size_t a, std::size_t b) {
    if (visibility[a] == visibility[b] || !is_same_surface(seen.points[a], seen.points[b])) return;
    edges.lit[visibility[a] > visibility[b] ? a : b] = true;
    edges.dark[visibility[a] > visibility[b] ? b : a] = true;
  };
  const auto width = static_cast<std::size_t>(seen.width);
  for (std::size_t i = 0; i < seen.points.size(); ++i) {
    edges.lit_receivers += seen.points[i].counts && visibility[i] > 0.0f;
    if ((i + 1) % width != 0) compare(i, i + 1);
    if (i + width < seen.points.size()) compare(i, i + width);
  }
  return edges;
}

EdgeCount EdgeMeter::count(const Camera& camera, const Light& light, double aspect, int width) const {
  truth::ReceiverImage seen = look(camera, aspect, width);
  EdgeCount result;
  result.pixels = static_cast<int>(seen.points.size());
  result.surfaces = static_cast<int>(std::ranges::count(seen.points, true, &truth::ReceiverPoint::counts));
  const Edges edges = find_edges(seen, light);
  result.lit = edges.lit_receivers;
  for (std::size_t i = 0; i < edges.lit.size(); ++i) result.at_edge += edges.lit[i] || edges.dark[i];
  return result;
}

std::vector<EdgePenumbra> EdgeMeter::list_penumbrae(const Camera& camera, const Light& light, double aspect) const {
  truth::ReceiverImage seen = look(camera, aspect, kFineWidth);
  const Edges edges = find_edges(seen, light);
  for (std::size_t i = 0; i < edges.dark.size(); ++i) seen.points[i].counts = edges.dark[i];
  const truth::AreaLight area = make_area_light(light);
  std::vector<float> distances(seen.points.size(), 0.0f);
  for (const Part* part : parts()) {
    if (!part->casts_shadow) continue;
    const std::vector<float> found = truth::trace_first_blockers(part->surfaces, seen, area);
    for (std::size_t i = 0; i < found.size(); ++i)
      if (std::isfinite(found[i])) distances[i] = std::max(distances[i], found[i]);
  }
  std::vector<EdgePenumbra> penumbrae;
  for (std::size_t i = 0; i < distances.size(); ++i) {
    if (!(distances[i] > 0.0f)) continue;
    const auto behind = static_cast<double>(distances[i]);  // the occluder, metres
    const glm::vec3& position = seen.points[i].position_ws;
    const bool is_lamp = std::isfinite(area.reach());
    const double before = is_lamp ? glm::length(area.centre_direction(glm::dvec3(position))) - behind : 1.0;
    if (before > 0.0) penumbrae.push_back({position, light_size(light) * behind / before});
  }
  return penumbrae;
}

bool is_light_in_view(const Scene& lit, std::span<const Camera> views, double aspect) {
  const EdgeMeter meter(lit);
  for (const int width : {EdgeMeter::kCoarseWidth, 10 * EdgeMeter::kCoarseWidth})
    for (const Camera& view : views)
      if (meter.count(view, lit.light, aspect, width).lit > 0) return true;
  return false;
}

}  // namespace shadowbench::scene
