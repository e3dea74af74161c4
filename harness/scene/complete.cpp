#include "harness/scene/complete.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <limits>
#include <utility>
#include <vector>

#include "harness/scene/mesh_tools.h"
#include "harness/scene/primitives.h"
#include "harness/scene/validate.h"

namespace shadowbench::scene {
namespace {

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

/// What is framed: the scene without its triangles.
Scene without_triangles(const Scene& scene) {
  Scene shape;
  shape.cameras = scene.cameras;
  shape.light = scene.light;
  shape.other_lights = scene.other_lights;
  for (const Mesh& mesh : scene.meshes) shape.meshes.emplace_back().vertices = mesh.vertices;
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

/// Counts edges in views of one scene.
class ViewSearch {
 public:
  ViewSearch(const Scene& scene, const ViewFreedom& free) : free_(free), meter_(scene) {}

  /// Counts under one sun for each place of the camera. `shape` is what is framed: the scene, or its outline.
  std::vector<EdgeCount> count(Scene& shape, const SkyAngles& sun, const std::vector<SkyAngles>& cameras) {
    if (free_.sun) shape.light = place_in_sky(shape.light, sun);
    std::vector<Light> lights = shape.other_lights;
    lights.push_back(shape.light);
    std::optional<Mesh> floor;
    if (free_.ground_y) floor = make_floor(place_floor(shape, *free_.ground_y));
    meter_.set_floor(floor ? &*floor : nullptr);
    std::vector<EdgeCount> counts(cameras.size());
    tbb::parallel_for(std::size_t{0}, cameras.size(), [&](std::size_t i) {
      const std::vector<Camera> views =
          free_.camera ? std::vector{frame_camera(shape, cameras[i], kPictureAspect, free_.ground_y)} : shape.cameras;
      for (const Camera& view : views) counts[i] += meter_.count(view, lights, kPictureAspect);
    });
    return counts;
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

/// All views worth a try; the usual one comes first, whatever it is.
std::vector<Attempt> list_attempts(const Scene& scene, const ViewFreedom& free, const ViewAngles& usual) {
  const Bounds bounds = scene.bounds();
  const glm::vec3 center = 0.5f * (bounds.min + bounds.max);
  std::vector<Attempt> attempts;
  for (const SkyAngles& sun : free.sun ? look_around(usual.sun, kLowSunDeg) : std::vector{usual.sun}) {
    Attempt& attempt = attempts.emplace_back(Attempt{sun, {}});
    const glm::dvec3 light = to_light(free.sun ? place_in_sky(scene.light, sun) : scene.light, center);
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

/// Adds the usual sun and camera, where they are free, and puts the lights where they were asked for.
Scene with_usual_view(Scene scene, const ViewFreedom& free, const Completion& completion) {
  const ViewAngles usual = usual_view(scene.bounds());
  if (completion.needs_sun) scene.light = place_in_sky({}, usual.sun);
  const auto place = [&](Light& light) {
    if (completion.light) light = place_in_sky(light, *completion.light);
  };
  place(scene.light);
  std::ranges::for_each(scene.other_lights, place);
  if (free.camera) scene.cameras.push_back(frame_camera(scene, usual.camera, completion.aspect, free.ground_y));
  return scene;
}

Scene with_chosen_view(Scene scene, const ViewFreedom& free, double aspect) {
  const ViewChoice choice = choose_view(scene, free);
  if (free.sun) scene.light = place_in_sky(scene.light, choice.angles.sun);
  if (free.camera) scene.cameras = {frame_camera(scene, choice.angles.camera, aspect, free.ground_y)};
  (choice.shows_edges() ? scene.notes : scene.warnings).push_back(describe_choice(choice, free));
  return scene;
}

}  // namespace

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

bool would_be_thin(const Bounds& bounds, const SkyAngles& from) {
  constexpr double kFarthestOffDeg = 35.0;
  const glm::vec3 size = bounds.max - bounds.min;
  const std::optional<double> axis_deg = long_axis_deg(bounds);
  if (!axis_deg || std::max(size.x, size.z) <= kElongated * size.y) return false;
  return std::abs(std::cos(glm::radians(from.azimuth_deg - *axis_deg))) <= std::cos(glm::radians(kFarthestOffDeg));
}

ViewAngles usual_view(const Bounds& bounds) {
  const double azimuth_deg = camera_azimuth_deg(bounds);
  return {{azimuth_deg, kCameraElevationDeg}, {azimuth_deg + kSunFromCameraDeg, kSunElevationDeg}};
}

float ground_height(const Scene& scene) {
  constexpr float kGap = 5e-4f;
  const Bounds bounds = scene.bounds();
  const float away_from_rounding = 1e-6f * std::abs(bounds.min.y);
  return bounds.min.y - std::max(kGap * glm::length(bounds.max - bounds.min), away_from_rounding);
}

Floor place_floor(const Scene& scene, float ground_y) {
  constexpr float kBorder = 0.15f;
  Bounds covered;
  for (const glm::dvec3& p : points_to_show(scene, ground_y)) covered.add(glm::vec3(p.x, ground_y, p.z));
  const glm::vec3 size = covered.max - covered.min;
  const float border = 2.0f * kBorder * std::max(size.x, size.z);
  return {{size.x + border, size.z + border}, 0.5f * (covered.min + covered.max)};
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
  Scene shape = without_triangles(scene);
  Scene outline = thinned(shape);
  double best = -1.0;
  for (const auto& [sun, cameras] : list_attempts(scene, free, usual)) {
    const std::vector<EdgeCount> counts = search.count(outline, sun, cameras);
    choice.tried += static_cast<int>(counts.size());
    for (std::size_t i = 0; i < counts.size(); ++i) {
      if (!(counts[i].share() > best)) continue;
      best = counts[i].share();
      choice.angles = {cameras[i], sun};
    }
  }
  // The outline is framed a little otherwise: what is said, and that it is no worse, holds for the scene itself.
  choice.usual_edges = search.count(shape, usual.sun, {usual.camera}).front();
  choice.edges = search.count(shape, choice.angles.sun, {choice.angles.camera}).front();
  choice.is_usual = !(choice.edges.share() > choice.usual_edges.share());
  if (choice.is_usual) choice.angles = usual, choice.edges = choice.usual_edges;
  return choice;
}

std::string describe_choice(const ViewChoice& choice, const ViewFreedom& free) {
  std::string text;
  if (free.camera) text = "camera from " + name_angles(choice.angles.camera);
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

Scene complete(Scene scene, const Completion& completion, const std::string& where) {
  ViewFreedom free{.camera = scene.cameras.empty(), .sun = completion.needs_sun && !completion.light};
  if (completion.ground) free.ground_y = ground_height(scene);
  scene = validate(with_usual_view(std::move(scene), free, completion), where);
  if (free.camera || free.sun) scene = with_chosen_view(std::move(scene), free, completion.aspect);
  return free.ground_y ? with_floor(std::move(scene), *free.ground_y) : scene;
}

}  // namespace shadowbench::scene
