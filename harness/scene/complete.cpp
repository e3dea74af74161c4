#include "harness/scene/complete.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <iterator>
#include <limits>
#include <numbers>
#include <utility>

#include "harness/scene/lights/light_fit.h"
#include "harness/scene/mesh_tools.h"

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

constexpr double kCameraAzimuthDeg = 30.0;
constexpr double kCameraOffLongAxisDeg = 14.0;
constexpr double kCameraElevationDeg = 24.0;
constexpr double kVerticalFovDeg = 40.0;
constexpr double kMargin = 1.04;
constexpr double kSunFromCameraDeg = 80.0;
constexpr double kSunElevationDeg = 50.0;

constexpr float kElongated = 3.0f;

/// The azimuth of the long axis of a scene that is much longer than wide; others have none.
std::optional<double> long_axis_deg(const Bounds& bounds) {
  const glm::vec3 size = bounds.max - bounds.min;
  if (size.x > kElongated * size.z) return 90.0;
  return size.z > kElongated * size.x ? std::optional(0.0) : std::nullopt;
}

/// The camera looks from three quarters, or from near the end of a long scene.
double camera_azimuth_deg(const Bounds& bounds) {
  const std::optional<double> axis_deg = long_axis_deg(bounds);
  if (!axis_deg) return kCameraAzimuthDeg;
  return std::abs(*axis_deg - kCameraOffLongAxisDeg);
}

/// Where the light throws a point on the plane y = ground_y; nothing for a light that does not come from above.
std::optional<glm::dvec3> shadow_of(const glm::vec3& p, const Light& light, float ground_y) {
  constexpr double kLowestSine = 0.1;
  const glm::dvec3 direction = glm::normalize(glm::dvec3(to_light(light, p)));
  if (direction.y < kLowestSine) return std::nullopt;
  return glm::dvec3(p) + direction * ((static_cast<double>(ground_y) - static_cast<double>(p.y)) / direction.y);
}

std::vector<glm::dvec3> points_to_show(const Scene& scene, std::optional<float> ground_y) {
  std::vector<glm::dvec3> points;
  for (const Mesh& mesh : scene.meshes) {
    for (const Vertex& vertex : mesh.vertices) {
      points.emplace_back(vertex.position_ws);
      if (!ground_y) continue;
      if (const auto shadow = shadow_of(vertex.position_ws, scene.light, *ground_y)) points.push_back(*shadow);
    }
  }
  return points;
}

/// The two planes of a frustum that bound one axis of the picture. They touch the points when the eye is at `centre`
/// along the axis and `distance` behind the origin.
struct Slab {
  double low = std::numeric_limits<double>::lowest();
  double high = std::numeric_limits<double>::lowest();
  double tangent;
  void add(double across, double ahead) {
    high = std::max(high, across - tangent * ahead);
    low = std::max(low, -across - tangent * ahead);
  }
  double centre() const { return 0.5 * (high - low); }
  double distance() const { return 0.5 * (high + low) / tangent; }
};

constexpr double kPictureAspect = 16.0 / 9.0;
constexpr std::size_t kMostTriangles = std::size_t{1} << 20;
constexpr double kHighCameraDeg = 40.0;
constexpr double kLowSunDeg = 35.0;

/// The usual place in the sky, then others all around, then the same at another elevation.
std::vector<SkyAngles> look_around(const SkyAngles& usual, double other_elevation_deg) {
  constexpr int kTurns = 8;
  std::vector<SkyAngles> places;
  for (const double elevation_deg : {usual.elevation_deg, other_elevation_deg})
    for (int i = 0; i < kTurns; ++i)
      places.push_back({std::fmod(usual.azimuth_deg + 360.0 * i / kTurns, 360.0), elevation_deg});
  return places;
}

/// What is framed: the scene without its triangles, or these points of it where there are any.
Scene make_shape(const Scene& scene, const std::vector<glm::vec3>& points = {}) {
  Scene shape;
  shape.cameras = scene.cameras;
  shape.light = scene.light;
  if (points.empty())
    for (const Mesh& mesh : scene.meshes) shape.meshes.emplace_back().vertices = mesh.vertices;
  else
    for (std::vector<Vertex>& vertices = shape.meshes.emplace_back().vertices; const glm::vec3& point : points)
      vertices.push_back({point});
  return shape;
}

/// The same with one vertex at most for each cell of a lattice: it is framed quickly, and but for 1/32 as the scene is.
Scene thinned(Scene shape) {
  constexpr int kCells = 32;
  const Bounds bounds = shape.bounds();
  const glm::dvec3 low(bounds.min), size = glm::max(glm::dvec3(bounds.max) - low, 1e-30);
  std::vector<bool> taken(std::size_t{kCells} * kCells * kCells);
  const auto is_taken = [&](const Vertex& vertex) {
    const glm::dvec3 place =
        glm::min(static_cast<double>(kCells) * (glm::dvec3(vertex.position_ws) - low) / size, kCells - 1.0);
    const glm::uvec3 cell(place);
    const std::size_t i = (std::size_t{cell.x} * kCells + cell.y) * kCells + cell.z;
    const bool known = taken[i];
    taken[i] = true;
    return known;
  };
  for (Mesh& mesh : shape.meshes) std::erase_if(mesh.vertices, is_taken);
  return shape;
}

/// The place of a floor at that height, under the meshes and the shadows that the scene's light throws on it.
Floor place_floor(const Scene& scene, float ground_y) {
  constexpr float kBorder = 0.15f;
  Bounds covered;
  for (const glm::dvec3& p : points_to_show(scene, ground_y)) covered.add(glm::vec3(p.x, ground_y, p.z));
  const glm::vec3 size = covered.max - covered.min;
  const float border = 2.0f * kBorder * std::max(size.x, size.z);
  return {{size.x + border, size.z + border}, 0.5f * (covered.min + covered.max)};
}

/// Just below the meshes: near enough to look like contact, far enough not to coincide.
float ground_height(const Scene& scene) {
  constexpr float kGap = 5e-4f;
  const Bounds bounds = scene.bounds();
  const float away_from_rounding = 1e-6f * std::abs(bounds.min.y);
  return bounds.min.y - std::max(kGap * glm::length(bounds.max - bounds.min), away_from_rounding);
}

/// Counts edges in views of one scene.
class ViewSearch {
 public:
  ViewSearch(const Scene& scene, const ViewFreedom& free) : free_(free), meter_(scene) {}

  /// Counts under one sun for each place of the camera. `whole` is the scene or its outline, `framed` that or a part.
  std::vector<EdgeCount> count(Scene& whole, const Scene& framed, const SkyAngles& sun,
                               const std::vector<SkyAngles>& cameras) {
    if (free_.sun) whole.light = place_in_sky(whole.light, sun);
    std::optional<Mesh> floor;
    if (free_.ground_y) floor = make_floor(place_floor(whole, *free_.ground_y));
    meter_.set_floor(floor ? &*floor : nullptr);
    std::vector<EdgeCount> counts(cameras.size());
    tbb::parallel_for(std::size_t{0}, cameras.size(), [&](std::size_t i) {
      const std::vector<Camera> views =
          free_.camera ? std::vector{frame_camera(framed, cameras[i], kPictureAspect, free_.ground_y)} : whole.cameras;
      for (const Camera& view : views) counts[i] += meter_.count(view, whole.light, kPictureAspect);
    });
    return counts;
  }

  /// What the light shines on near by; empty for one at infinity.
  std::vector<glm::vec3> find_lit_points(const Light& light) const {
    const std::optional<Beam> lamp = find_beam(light);
    return lamp && free_.camera ? meter_.find_lit_points(*lamp) : std::vector<glm::vec3>();
  }

 private:
  ViewFreedom free_;
  EdgeMeter meter_;
};

/// Whether the light shines towards the camera: the sides of things that it sees would be those in shadow.
bool is_against_light(const glm::dvec3& forward, const glm::dvec3& to_light) {
  constexpr double kMost = 0.25;  // of the light's direction that is level and ahead
  return glm::dot(glm::normalize(glm::dvec2(forward.x, forward.z)), glm::dvec2(to_light.x, to_light.z)) > kMost;
}

/// The cameras to try under one sun.
struct Attempt {
  SkyAngles sun;
  std::vector<SkyAngles> cameras;
};

bool is_much_longer(const Bounds& bounds) {
  const glm::vec3 size = bounds.max - bounds.min;
  return long_axis_deg(bounds) && std::max(size.x, size.z) > kElongated * size.y;
}

/// Whether a scene that is much longer than wide and high is seen from its long side, where it is a thin line.
bool would_be_thin(const Bounds& bounds, const SkyAngles& from) {
  constexpr double kFarthestOffDeg = 35.0;
  if (!is_much_longer(bounds)) return false;
  return std::abs(std::cos(glm::radians(from.azimuth_deg - *long_axis_deg(bounds)))) <=
         std::cos(glm::radians(kFarthestOffDeg));
}

/// All views of a scene, or of a part of it, that are worth a try; the usual one comes first, whatever it is.
std::vector<Attempt> list_attempts(const Scene& framed, const ViewFreedom& free, const ViewAngles& usual) {
  const Bounds bounds = framed.bounds();
  const glm::vec3 center = 0.5f * (bounds.min + bounds.max);
  std::vector<Attempt> attempts;
  for (const SkyAngles& sun : free.sun ? look_around(usual.sun, kLowSunDeg) : std::vector{usual.sun}) {
    Attempt& attempt = attempts.emplace_back(Attempt{sun, {}});
    const glm::dvec3 light = to_light(free.sun ? place_in_sky(framed.light, sun) : framed.light, center);
    for (const SkyAngles& camera :
         free.camera ? look_around(usual.camera, kHighCameraDeg) : std::vector{usual.camera}) {
      const glm::dvec3 forward = light_direction(camera.azimuth_deg, camera.elevation_deg);
      const bool is_usual = attempts.size() == 1 && attempt.cameras.empty();
      if (is_usual || !free.camera || (!is_against_light(forward, light) && !would_be_thin(bounds, camera)))
        attempt.cameras.push_back(camera);
    }
  }
  return attempts;
}

/// Moving the scene to its own origin does not bring back what its file has lost.
void warn_of_rounding(Scene& scene) {
  constexpr double kMost = 1e-5;  // of the scene's size: a twenty-fifth of a texel of a map of 4096
  const Bounds bounds = scene.bounds();
  if (bounds.empty() || scene.rounding_m < kMost * static_cast<double>(glm::length(bounds.max - bounds.min))) return;
  scene.warnings.push_back(fmt::format(
      "single precision rounds positions in its file to {:.2g} m, so far are they from their nodes' origins; "
      "move the model to its origin in its own program",
      2.0 * scene.rounding_m));
}

/// Where a scene's own floor is, over a lattice of places: the first surface below the middle of its height.
std::vector<glm::dvec3> find_floor(const EdgeMeter& meter, const Bounds& bounds) {
  constexpr int kPlaces = 16;
  const glm::dvec3 low(bounds.min), size = glm::dvec3(bounds.max) - low;
  std::vector<SceneRay> rays;
  for (int x = 0; x < kPlaces; ++x)
    for (int z = 0; z < kPlaces; ++z)
      rays.push_back({low + size * glm::dvec3((x + 0.5) / kPlaces, 0.5, (z + 0.5) / kPlaces), {0.0, -1.0, 0.0}});
  std::vector<glm::dvec3> floor;
  for (const truth::ReceiverPoint& each : meter.trace(rays))
    if (each.counts && each.normal_ws.y > 0.7f) floor.emplace_back(each.position_ws);
  return 2 * floor.size() > rays.size() ? floor : std::vector<glm::dvec3>();
}

/// How far one sees along a level ray: to a surface, or to where the scene ends.
double measure_way(const SceneRay& ray, const truth::ReceiverPoint& met, const Bounds& bounds) {
  if (met.counts) return glm::distance(ray.origin, glm::dvec3(met.position_ws));
  double way = std::numeric_limits<double>::max();
  for (const int axis : {0, 2})
    if (const double step = ray.direction[axis]; step != 0.0)
      way = std::min(way,
                     (static_cast<double>(step > 0.0 ? bounds.max[axis] : bounds.min[axis]) - ray.origin[axis]) / step);
  return way;
}

/// Gives a scene that one walks through its camera, where that shows the edge of a shadow.
void stand_inside(Scene& scene, const ViewFreedom& free) {
  if (!is_much_longer(scene.bounds()) || scene.triangle_count() > kMostTriangles) return;
  const std::optional<Camera> camera = find_walk_through(scene);
  if (!camera) return;
  Scene seen = scene;
  seen.cameras = {*camera};
  if (choose_view(seen, {.sun = free.sun}).edges.at_edge == 0) return;
  scene.cameras = seen.cameras;
  scene.notes.emplace_back("camera in the scene at eye height, along the longest way that it sees");
}

std::string name_angles(const SkyAngles& angles) {
  return fmt::format("azimuth {}, elevation {}", angles.azimuth_deg, angles.elevation_deg);
}

Scene with_floor(Scene scene, float ground_y) {
  Material material;
  material.name = "ground";
  material.base_color = {0.42f, 0.40f, 0.37f, 1.0f};
  scene.floor = place_floor(scene, ground_y);
  Mesh mesh = make_floor(*scene.floor);
  mesh.material = static_cast<int>(scene.materials.size());
  scene.materials.push_back(material);
  scene.meshes.push_back(std::move(mesh));
  return scene;
}

/// Leaves out lights of intensity 0, with the cameras that look at them alone. Returns whether none is left.
bool leave_out_dark_lights(Scene& scene) {
  std::vector<Light> lights = std::exchange(scene.other_lights, {});
  lights.insert(lights.begin(), std::move(scene.light));
  std::erase_if(lights, [&](const Light& light) {
    if (light.intensity != 0.0f) return false;
    const std::string& name = light.name;
    scene.warnings.push_back(
        fmt::format("{} has an intensity of 0; it is left out", name.empty() ? "a light" : "the light '" + name + "'"));
    if (!name.empty()) std::erase_if(scene.cameras, [&](const Camera& each) { return each.light == name; });
    return true;
  });
  if (lights.empty()) return true;
  scene.light = std::move(lights.front());
  scene.other_lights.assign(std::next(lights.begin()), lights.end());
  return false;
}

/// Adds the usual sun, where there is none, and puts the lights where they were asked for.
Scene with_placed_lights(Scene scene, const Completion& completion) {
  if (completion.needs_sun) scene.light = place_in_sky({}, usual_view(scene.bounds()).sun);
  const auto place = [&](Light& light) {
    if (completion.light) light = place_in_sky(light, *completion.light);
  };
  place(scene.light);
  std::ranges::for_each(scene.other_lights, place);
  return scene;
}

/// The camera of a choice, for a picture of the given width / height.
Camera frame_choice(const Scene& scene, const ViewChoice& choice, double aspect, const ViewFreedom& free) {
  const Scene shape = make_shape(scene, choice.near_light);
  return frame_camera(shape, choice.angles.camera, aspect, free.ground_y);
}

/// Chooses what is free of the view of one light: `lit` is the scene with that light alone.
void choose_for_light(Scene& scene, const Scene& lit, const ViewFreedom& free, double aspect) {
  const std::string& light = scene.other_lights.empty() ? std::string() : lit.light.name;
  const ViewChoice choice = choose_view(lit, free);
  if (free.sun) scene.light = place_in_sky(scene.light, choice.angles.sun);
  if (free.camera) {
    scene.cameras.push_back(frame_choice(free.sun ? scene : lit, choice, aspect, free));
    if (!light.empty()) scene.cameras.back().name = scene.cameras.back().light = light;
  }
  // Of a light that reaches nothing in view, who draws the scene says more: is_light_in_view().
  if (choice.tried > 0 && choice.edges.lit == 0) return;
  (choice.shows_edges() ? scene.notes : scene.warnings).push_back(describe_choice(choice, free, light));
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

Camera frame_camera(const Scene& scene, const SkyAngles& from, double aspect, std::optional<float> ground_y) {
  const Bounds bounds = scene.bounds();
  const glm::dvec3 forward = light_direction(from.azimuth_deg, from.elevation_deg);
  const glm::dvec3 right = glm::normalize(glm::cross(forward, glm::dvec3(0.0, 1.0, 0.0)));
  const glm::dvec3 up = glm::cross(right, forward);
  const double tangent = std::tan(0.5 * glm::radians(kVerticalFovDeg)) / kMargin;
  Slab horizontal{.tangent = tangent * aspect};
  Slab vertical{.tangent = tangent};
  double nearest = std::numeric_limits<double>::max();
  for (const glm::dvec3& p : points_to_show(scene, ground_y)) {
    horizontal.add(glm::dot(p, right), glm::dot(p, forward));
    vertical.add(glm::dot(p, up), glm::dot(p, forward));
    nearest = std::min(nearest, glm::dot(p, forward));
  }
  const double gap = 1e-3 * static_cast<double>(glm::length(bounds.max - bounds.min));
  const double distance = std::max({horizontal.distance(), vertical.distance(), gap - nearest});
  Camera camera;
  camera.position_ws = glm::vec3(right * horizontal.centre() + up * vertical.centre() - forward * distance);
  camera.forward_ws = glm::vec3(forward);
  camera.up_ws = glm::vec3(up);
  camera.vertical_fov_rad = static_cast<float>(glm::radians(kVerticalFovDeg));
  return camera;
}

std::optional<Camera> find_walk_through(const Scene& scene) {
  constexpr int kTurns = 16;
  const Bounds bounds = scene.bounds();
  const EdgeMeter meter(scene);
  const double height = static_cast<double>(bounds.max.y - bounds.min.y);
  const glm::dvec3 eye(0.0, std::clamp(1.7, 0.05 * height, 0.25 * height), 0.0);
  std::vector<SceneRay> rays;
  for (const glm::dvec3& place : find_floor(meter, bounds))
    for (int i = 0; i < kTurns; ++i) rays.push_back({place + eye, light_direction(360.0 * i / kTurns, 0.0)});
  if (rays.empty()) return std::nullopt;
  const std::vector<truth::ReceiverPoint> met = meter.trace(rays);
  std::vector<double> ways;  // less the distance from the middle of the scene
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const glm::dvec3 aside = glm::cross(rays[i].origin - 0.5 * glm::dvec3(bounds.min + bounds.max), rays[i].direction);
    ways.push_back(measure_way(rays[i], met[i], bounds) - std::abs(aside.y));
  }
  const SceneRay& longest = rays[static_cast<std::size_t>(std::ranges::max_element(ways) - ways.begin())];
  Camera camera;
  camera.position_ws = glm::vec3(longest.origin);
  camera.forward_ws = glm::vec3(longest.direction);
  camera.vertical_fov_rad = static_cast<float>(glm::radians(kVerticalFovDeg));
  return camera;
}

ViewAngles usual_view(const Bounds& bounds) {
  const double azimuth_deg = camera_azimuth_deg(bounds);
  return {{azimuth_deg, kCameraElevationDeg}, {azimuth_deg + kSunFromCameraDeg, kSunElevationDeg}};
}

Mesh make_floor(const Floor& floor) {
  Mesh mesh = without_unused_vertices(transform_mesh(make_plane(floor.size_m, kFloorCells),
                                                     glm::translate(glm::dmat4(1.0), glm::dvec3(floor.center_ws))));
  mesh.name = "ground";
  return mesh;
}

ViewChoice choose_view(const Scene& scene, const ViewFreedom& free) {
  const ViewAngles usual = usual_view(scene.bounds());
  ViewChoice choice;
  choice.angles = usual;
  if (scene.triangle_count() > kMostTriangles) return choice;
  ViewSearch search(scene, free);
  Scene whole = make_shape(scene), outline = thinned(whole);
  const std::vector<glm::vec3> near_light = search.find_lit_points(scene.light);
  std::vector<Scene> shapes = {outline};
  if (!near_light.empty()) shapes.push_back(make_shape(scene, near_light));
  double best = -1.0;
  for (std::size_t shape = 0; shape < shapes.size(); ++shape) {
    for (const auto& [sun, cameras] : list_attempts(shapes[shape], free, usual)) {
      const std::vector<EdgeCount> counts = search.count(outline, shapes[shape], sun, cameras);
      choice.tried += static_cast<int>(counts.size());
      for (std::size_t i = 0; i < counts.size(); ++i) {
        if (!(counts[i].share() > best)) continue;
        best = counts[i].share();
        choice.angles = {cameras[i], sun};
        choice.near_light = shape > 0 ? near_light : std::vector<glm::vec3>();
      }
    }
  }
  // The outline is framed a little otherwise: what is said, and that it is no worse, holds for the scene itself.
  const auto count = [&](const ViewAngles& angles, const std::vector<glm::vec3>& framed) {
    if (framed.empty()) return search.count(whole, whole, angles.sun, {angles.camera}).front();
    return search.count(whole, make_shape(scene, framed), angles.sun, {angles.camera}).front();
  };
  choice.usual_edges = count(usual, {});
  choice.edges = count(choice.angles, choice.near_light);
  choice.is_usual = !(choice.edges.share() > choice.usual_edges.share());
  if (choice.is_usual) choice.angles = usual, choice.edges = choice.usual_edges, choice.near_light.clear();
  return choice;
}

std::string describe_choice(const ViewChoice& choice, const ViewFreedom& free, const std::string& light) {
  std::string text;
  if (free.camera)
    text = fmt::format("camera{} from {}{}", light.empty() ? "" : fmt::format(" for the light '{}'", light),
                       name_angles(choice.angles.camera), choice.near_light.empty() ? "" : ", near the light");
  if (free.sun) text += (free.camera ? "; " : "") + ("sun from " + name_angles(choice.angles.sun));
  if (choice.tried == 0)
    return fmt::format("{}: the usual view; no other is tried with more than {} triangles", text, kMostTriangles);
  if (!choice.shows_edges())
    return fmt::format(
        "{}: the usual view, since none of {} that were tried shows the edge of a shadow: all filters will look alike; "
        "{}set camera and light in its file",
        text, choice.tried, free.ground_y ? "" : "add a floor (--ground), or ");
  const auto percent = [](const EdgeCount& edges) { return fmt::format("{:.1f} %", 100.0 * edges.share()); };
  return fmt::format("{}: edges of shadows touch {} of the picture's surfaces ({})", text, percent(choice.edges),
                     choice.is_usual ? "the usual view" : percent(choice.usual_edges) + " in the usual view");
}

Scene complete(Scene scene, Completion completion, const std::string& where) {
  warn_of_rounding(scene);
  if (leave_out_dark_lights(scene)) completion.needs_sun = true;
  ViewFreedom free{.sun = completion.needs_sun && !completion.light};
  if (completion.ground) free.ground_y = ground_height(scene);
  scene = validate(with_placed_lights(std::move(scene), completion), where);
  if (scene.cameras.empty() && scene.other_lights.empty() && !completion.ground) stand_inside(scene, free);
  for (const Scene& lit : separate_lights(scene)) {
    free.camera = lit.cameras.empty();
    if (free.camera || free.sun) choose_for_light(scene, lit, free, completion.aspect);
  }
  // Who shows one light alone takes the first, and its first view.
  std::ranges::stable_partition(
      scene.cameras, [&](const Camera& each) { return each.light.empty() || each.light == scene.light.name; });
  return free.ground_y ? with_floor(std::move(scene), *free.ground_y) : scene;
}

}  // namespace shadowbench::scene
