#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

#include "harness/scene/lights/light_fit.h"
#include "harness/scene/lights/light_kinds.h"
#include "harness/scene/mesh_tools.h"
#include "harness/scene/scene.h"

namespace shadowbench::scene {
namespace {

/// The light's axes, and the place that its coordinates count from.
struct SunView {
  SunView(const Sun& sun, const Scene& scene, const FitRequest& request)
      : direction(glm::normalize(glm::dvec3(sun.direction_ws))),
        rotation(light_rotation(direction)),
        bounds(scene.bounds()),
        center(0.5 * (glm::dvec3(bounds.min) + glm::dvec3(bounds.max))),
        used_texels(count_used_texels(request)) {}

  glm::dvec3 direction;
  glm::dmat3 rotation;
  Bounds bounds;
  glm::dvec3 center;
  double used_texels;
};

/// A box in the light's space.
struct Box {
  glm::dvec3 min{std::numeric_limits<double>::max()};
  glm::dvec3 max{std::numeric_limits<double>::lowest()};
};

void add(Box& box, const glm::dvec3& seen) {
  box.min = glm::min(box.min, seen);
  box.max = glm::max(box.max, seen);
}

template <typename Visit>
void for_each_position(const Scene& scene, const Visit& visit) {
  for (const Mesh& mesh : scene.meshes)
    for (const Vertex& vertex : mesh.vertices) visit(glm::dvec3(vertex.position_ws));
}

/// The scene's extent around `center`, along the light's axes.
Box tight_box(const Scene& scene, const glm::dmat3& rotation, const glm::dvec3& center) {
  Box box;
  for_each_position(scene, [&](const glm::dvec3& p) { add(box, rotation * (p - center)); });
  return box;
}

Box sphere_box(const Scene& scene, const glm::dvec3& center) {
  double radius = 0.0;
  for_each_position(scene, [&](const glm::dvec3& p) { radius = std::max(radius, glm::length(p - center)); });
  return {glm::dvec3(-radius), glm::dvec3(radius)};
}

/// Depth is computed in float, from coordinates as large as `largest_coordinate`.
double depth_padding(double range, double side, double largest_coordinate) {
  constexpr double kRelative = 1e-4;
  constexpr double kRoundings = 8.0 * double{std::numeric_limits<float>::epsilon()};
  const double flat = range < 1e-3 * side ? 5e-4 * side : 0.0;
  return std::max({kRelative * range, flat, kRoundings * largest_coordinate});
}

glm::dmat4 scale_then_move(const glm::dvec3& scale, const glm::dvec3& offset) {
  glm::dmat4 m(1.0);
  for (int i = 0; i < 3; ++i) m[i][i] = scale[i];
  m[3] = glm::dvec4(offset, 1.0);
  return m;
}

bool overlap(const Box& a, const Box& b) {
  return a.min.x <= b.max.x && b.min.x <= a.max.x && a.min.y <= b.max.y && b.min.y <= a.max.y;
}

/// Moves the box's near side towards the light until it holds every caster over the map; `margin` is the map's padding.
void add_casters(Box& box, const Scene& scene, const glm::dmat3& rotation, const glm::dvec3& center, double margin) {
  Box wide = box;
  wide.min -= glm::dvec3(margin);
  wide.max += glm::dvec3(margin);
  for (const Mesh& mesh : scene.meshes) {
    if (!mesh.casts_shadow) continue;
    for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
      Box triangle;
      for (std::size_t k = 0; k < 3; ++k)
        add(triangle, rotation * (glm::dvec3(mesh.vertices[mesh.indices[i + k]].position_ws) - center));
      if (overlap(triangle, wide)) box.max.z = std::max(box.max.z, triangle.max.z);
    }
  }
}

/// The side of the square map over a box, padding left out.
double square_side(const Box& box) {
  const glm::dvec3 extent = box.max - box.min;
  return std::max({extent.x, extent.y, 1e-3 * extent.z});
}

Box box_over(const std::vector<glm::dvec3>& receivers, const Scene& scene, const FitRequest& request,
             const SunView& view) {
  Box box;
  for (const glm::dvec3& p : receivers) add(box, view.rotation * (p - view.center));
  if (box.min.x > box.max.x) return tight_box(scene, view.rotation, view.center);
  // The square map may reach beyond the box on its shorter side, snapping included.
  const double side = square_side(box);
  const double map_side = 1.1 * side * request.map_size / view.used_texels;
  add_casters(box, scene, view.rotation, view.center,
              map_side - std::min(box.max.x - box.min.x, box.max.y - box.min.y));
  return box;
}

double round_up_texel(double texel_ws) {
  constexpr double kStepsPerOctave = 8.0;
  return std::exp2(std::ceil(std::log2(texel_ws) * kStepsPerOctave - 1e-9) / kStepsPerOctave);
}

/// Moves a place in the light's space to a whole number of texels from the world's origin.
glm::dvec3 snap_to_texels(const glm::dvec3& place, const glm::dvec3& world_origin, double texel_ws) {
  const auto snapped = [&](int axis) {
    return std::round((place[axis] - world_origin[axis]) / texel_ws) * texel_ws + world_origin[axis];
  };
  return {snapped(0), snapped(1), place.z};
}

void set_matrices(LightFrustum& fit) {
  const double half = 2.0 / fit.width_ws;
  fit.clip_from_light = scale_then_move({half, half, -1.0 / fit.depth_range_ws}, glm::dvec3(0.0));
  const glm::dmat4 uv_from_clip = scale_then_move({0.5, 0.5, 1.0}, {0.5, 0.5, 0.0});
  fit.clip_from_world = glm::mat4(fit.clip_from_light * fit.light_from_world);
  fit.uv_depth_from_world = glm::mat4(uv_from_clip * fit.clip_from_light * fit.light_from_world);
}

/// Replaces what was fitted by what the window says; the light's direction stays.
void set_window(LightFrustum& fit, const MapWindow& window, int map_size) {
  const glm::dvec3 center(fit.light_from_world * glm::dvec4(window.center_ws, 1.0));
  glm::dvec3 eye(center.x, center.y, 0.0);
  if (window.planes) {
    eye.z = center.z - window.planes->near_m;
    fit.depth_range_ws = window.planes->far_m - window.planes->near_m;
  }
  fit.light_from_world[3] -= glm::dvec4(eye, 0.0);
  fit.width_ws = window.width_m;
  fit.texel_size_ws = window.width_m / map_size;
}

LightFrustum fit_box(const SunView& view, const Box& box, const MapWindow* window, const FitRequest& request) {
  const double side = square_side(box);
  const double range = box.max.z - box.min.z;
  const glm::dvec3 farthest = glm::max(glm::abs(glm::dvec3(view.bounds.min)), glm::abs(glm::dvec3(view.bounds.max)));
  const double padding = depth_padding(range, side, std::max({farthest.x, farthest.y, farthest.z}));

  LightFrustum fit;
  fit.texel_size_ws = side / view.used_texels;
  if (request.snap) fit.texel_size_ws = round_up_texel(fit.texel_size_ws);
  fit.width_ws = fit.texel_size_ws * request.map_size;
  fit.depth_range_ws = range + 2.0 * padding;
  fit.direction_ws = glm::vec3(view.direction);
  glm::dvec3 eye(0.5 * (box.min.x + box.max.x), 0.5 * (box.min.y + box.max.y), box.max.z + padding);
  if (request.snap) eye = snap_to_texels(eye, -(view.rotation * view.center), fit.texel_size_ws);
  fit.light_from_world = glm::dmat4(view.rotation);
  fit.light_from_world[3] = glm::dvec4(-(view.rotation * view.center) - eye, 1.0);
  if (window) set_window(fit, *window, request.map_size);
  fit.light_from_world[3] -= glm::dvec4(fit.texel_size_ws * request.shift_texels, 0.0, 0.0);
  set_matrices(fit);
  return fit;
}

glm::dvec3 read_sun_direction(const TomlTable& table) {
  const bool by_angles = table.has("azimuth_deg") || table.has("elevation_deg");
  if (table.has("direction") == by_angles) {
    throw table.error("direction",
                      "[light] needs a direction: either 'direction', or 'azimuth_deg' and 'elevation_deg'");
  }
  if (by_angles) {
    const double azimuth = table.number("azimuth_deg", {-360.0, 360.0});
    return light_direction(azimuth, table.number("elevation_deg", {-90.0, 90.0}));
  }
  const glm::dvec3 direction = table.vec3("direction", kAnyNumber);
  if (glm::length(direction) > 0.0) return direction;
  throw table.error("direction", "the light has no direction: 'direction' is [0, 0, 0]");
}

/// A camera that stands in the geometry has no nearest depth, and logarithmic slices need one.
constexpr double kNearestSplit = 1e-3;  // of the farthest

DepthSpan find_depths(const Scene& scene, const FitRequest& request) {
  if (request.cascades.seen && request.seen) return *request.seen;
  return find_depth_span(*request.camera, list_visible_corners(scene, *request.camera, request.aspect));
}

/// Where the slice around a border fades: its neighbours share the last part of the nearer one.
double fade_begin(const std::vector<double>& borders, std::size_t border, double blend) {
  return borders[border] - blend * (borders[border] - borders[border - 1]);
}

/// Every depth before the first border is the first slice's, and every one after the last the last one's.
ViewSlice make_slice(const std::vector<double>& borders, std::size_t slice, double blend) {
  const double everything = borders.back() * 1e6;
  ViewSlice made{-2.0 * everything, -everything, everything, 2.0 * everything, borders[slice + 1]};
  if (slice > 0) {
    made.fade_in_begin = fade_begin(borders, slice, blend);
    made.fade_in_end = borders[slice];
  }
  if (slice + 2 < borders.size()) {
    made.fade_out_begin = fade_begin(borders, slice + 1, blend);
    made.fade_out_end = borders[slice + 1];
  }
  return made;
}

/// Ends of a sphere around what the camera can see between two depths: its size does not change when the camera turns.
std::vector<glm::dvec3> bound_by_sphere(const Camera& camera, double aspect, const DepthSpan& span,
                                        const glm::dmat3& light_rotation) {
  const ViewCorners corners = list_view_corners(camera, aspect, span);
  glm::dvec3 center(0.0);
  for (const glm::dvec3& corner : corners) center += corner / static_cast<double>(corners.size());
  double radius = 0.0;
  for (const glm::dvec3& corner : corners) radius = std::max(radius, glm::length(corner - center));
  std::vector<glm::dvec3> ends;
  for (int axis = 0; axis < 3; ++axis)
    for (const double side : {-1.0, 1.0}) ends.push_back(center + side * radius * glm::transpose(light_rotation)[axis]);
  return ends;
}

}  // namespace

glm::dvec3 light_direction(double azimuth_deg, double elevation_deg) {
  const double azimuth = glm::radians(azimuth_deg);
  const double elevation = glm::radians(elevation_deg);
  return -glm::dvec3(std::cos(elevation) * std::sin(azimuth), std::sin(elevation),
                     std::cos(elevation) * std::cos(azimuth));
}

Sun read_sun(const TomlTable& table) {
  require_light_keys(table, {"direction", "azimuth_deg", "elevation_deg", "angular_diameter_deg", "map_center",
                             "map_width", "map_near", "map_far"});
  const glm::vec3 direction(read_sun_direction(table));
  return {direction, table.number_f("angular_diameter_deg", {0.0, 90.0}, Sun().angular_diameter_deg)};
}

glm::vec3 to_light(const Sun& sun, const glm::vec3&) { return -sun.direction_ws; }

std::optional<Beam> find_beam(const Sun&) { return std::nullopt; }

double light_size(const Sun& sun) {
  return 2.0 * std::tan(0.5 * glm::radians(static_cast<double>(sun.angular_diameter_deg)));
}

truth::AreaLight make_area_light(const Sun& sun) {
  return truth::AreaLight::make_sun(-glm::dvec3(sun.direction_ws), static_cast<double>(sun.angular_diameter_deg));
}

void turn_light(Sun& sun, const LightTurn& turn) { sun.direction_ws = turn(sun.direction_ws); }

void aim_light(Sun&, const glm::vec3&) {}

Sun checked_light(const Sun& given, const std::string& where) {
  Sun sun = given;
  sun.direction_ws = unit_direction(sun.direction_ws, "the light", where);
  if (sun.angular_diameter_deg >= 0.0f && sun.angular_diameter_deg < 180.0f) return sun;
  fail_input(fmt::format("the light's angular diameter is {} degrees", sun.angular_diameter_deg), where);
}

std::string describe_light(const Sun& sun) { return fmt::format("a sun of {:.3g} degrees", sun.angular_diameter_deg); }

std::vector<LightNumber> list_numbers(Sun& sun) {
  return {{"direction", NumberRole::kDirection, {&sun.direction_ws.x, 3}},
          {"angular_diameter_deg", NumberRole::kAngle, {&sun.angular_diameter_deg, 1}, Range{0.0, 20.0}}};
}

std::vector<double> split_depths(const CascadeRule& rule, double near_m, double far_m) {
  assert(near_m > 0.0 && near_m < far_m);
  std::vector<double> depths;
  for (int i = 0; i <= rule.count; ++i) {
    const double part = static_cast<double>(i) / rule.count;
    const double uniform = near_m + part * (far_m - near_m), logarithmic = near_m * std::pow(far_m / near_m, part);
    depths.push_back(rule.split * logarithmic + (1.0 - rule.split) * uniform);
  }
  return depths;
}

namespace {

/// Where slices begin and end, of what is in view between two depths. Throws kUsage where that ends before a split.
std::vector<double> find_borders(const CascadeRule& rule, const DepthSpan& seen) {
  const double seen_far = seen.far_m > 0.0 ? seen.far_m * (1.0 + 1e-6) : 1.0;
  const double far_m = rule.far_m > 0.0 ? rule.far_m : seen_far;
  const double last = !rule.splits.empty() ? rule.splits.back() : rule.near_m;
  if (last >= far_m)
    throw Error(ErrorKind::kUsage, fmt::format("--fit: cascades are to reach beyond {} m, but what is in view ends at "
                                               "{:.4g} m: lower near and splits, or set far",
                                               last, far_m));
  const double first = rule.splits.empty() ? far_m : rule.splits.front();
  const double near_m =
      rule.near_m > 0.0 ? rule.near_m : std::min(std::max(seen.near_m, kNearestSplit * far_m), 0.999 * first);
  if (rule.splits.empty()) return split_depths(rule, near_m, far_m);
  std::vector<double> borders = rule.splits;
  borders.insert(borders.begin(), near_m);
  borders.push_back(far_m);
  return borders;
}

/// Fits a layer of the sun's map to each slice of what the camera sees; see fit_layers().
std::vector<LightFrustum> fit_cascades(const Sun& sun, const Scene& scene, const FitRequest& request) {
  assert(request.camera);
  const DepthSpan depths = find_depths(scene, request);
  const std::vector<double> borders = find_borders(request.cascades, depths);
  const glm::dmat3 rotation = light_rotation(glm::normalize(glm::dvec3(sun.direction_ws)));
  std::vector<LightFrustum> layers;
  for (std::size_t slice = 0; slice + 1 < borders.size(); ++slice) {
    const ViewSlice share = make_slice(borders, slice, request.cascades.blend);
    const DepthSpan span{slice == 0 ? 0.0 : share.fade_in_begin, borders[slice + 1]};
    LightFrustum layer =
        fit_sun_over(sun, scene, request,
                     request.snap ? bound_by_sphere(*request.camera, request.aspect, span, rotation)
                                  : list_visible_corners(scene, *request.camera, request.aspect, span));
    layer.layer = static_cast<int>(slice);
    layer.share = share;
    layers.push_back(std::move(layer));
  }
  return layers;
}

LightFrustum fit_sun(const Sun& sun, const MapWindow* window, const Scene& scene, const FitRequest& request) {
  const SunView view(sun, scene, request);
  switch (request.mode) {
    case FitMode::kSphere: return fit_box(view, sphere_box(scene, view.center), window, request);
    case FitMode::kView:
      assert(request.camera);
      return fit_box(view, box_over(list_visible_corners(scene, *request.camera, request.aspect), scene, request, view),
                     window, request);
    default: break;
  }
  return fit_box(view, tight_box(scene, view.rotation, view.center), window, request);
}

}  // namespace

LightFrustum fit_sun_over(const Sun& sun, const Scene& scene, const FitRequest& request,
                          const std::vector<glm::dvec3>& receivers) {
  const SunView view(sun, scene, request);
  return fit_box(view, box_over(receivers, scene, request, view), nullptr, request);
}

int count_layers(const Sun&, const MapWindow* window, const FitRule& rule) {
  return rule.mode == FitMode::kCascades && !window ? rule.cascades.count : 1;
}

std::vector<LightFrustum> fit_layers(const Sun& sun, const MapWindow* window, const Scene& scene,
                                     const FitRequest& request) {
  if (request.mode == FitMode::kCascades && !window) return fit_cascades(sun, scene, request);
  if (is_warped(request.mode) && !window) return {fit_warped(sun, scene, request)};
  return {fit_sun(sun, window, scene, request)};
}

}  // namespace shadowbench::scene
