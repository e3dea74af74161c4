#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <limits>
#include <optional>

#include "base/error.h"
#include "harness/scene/lights/light_fit.h"
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

LightFrustum fit_whole(const Sun& sun, const MapWindow* window, const Scene& scene, const FitRequest& request) {
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

constexpr double kLeastNear = 1e-3;       // of the farthest depth: a camera in the geometry has no nearest one
constexpr double kLeastSine = 0.02;       // between view and light; below it a map has no direction to warp along
constexpr double kLeastNearShare = 0.25;  // of the camera's ratio of depths, below which a perspective map steps back

/// u, v and w as functions of a point (x, y, z, 1) in the world; none changes along the light. The map's place of a
/// point is u / w, v / w.
struct Rows {
  glm::dvec4 u{0.0}, v{0.0}, w{0.0, 0.0, 0.0, 1.0};
};

double apply(const glm::dvec4& row, const glm::dvec3& p) { return glm::dot(row, glm::dvec4(p, 1.0)); }

glm::dvec4 along(const glm::dvec3& axis, const glm::dvec3& origin) { return {axis, -glm::dot(axis, origin)}; }

/// What a camera sees, and the light's axes as it sees them.
struct View {
  std::vector<glm::dvec3> points;
  const Camera& camera;
  double aspect;
  glm::dvec3 eye, ahead, to_light;
  glm::dvec3 forward{0.0}, right{0.0};  ///< across the light; forward is the way that the camera looks
  double sine = 0.0;                    ///< between the camera's direction and the light's
  DepthSpan depths;

  View(const Sun& sun, const Scene& scene, const FitRequest& request)
      : points(list_visible_corners(scene, *request.camera, request.aspect)),
        camera(*request.camera),
        aspect(request.aspect),
        eye(camera.position_ws),
        ahead(glm::normalize(glm::dvec3(camera.forward_ws))),
        to_light(-glm::normalize(glm::dvec3(sun.direction_ws))) {
    const glm::dvec3 across = ahead - glm::dot(ahead, to_light) * to_light;
    sine = glm::length(across);
    forward = sine > kLeastSine ? across / sine : glm::transpose(light_rotation(-to_light))[1];
    right = glm::cross(forward, to_light);
    depths = find_depth_span(camera, points);
    depths.near_m = std::max(depths.near_m, kLeastNear * depths.far_m);
  }

  bool can_warp() const { return sine > kLeastSine && camera.orthographic_height_m <= 0.0f && depths.far_m > 0.0; }
};

Rows focus(const View& view) { return {along(view.right, view.eye), along(view.forward, view.eye)}; }

/// The projection whose w grows from `nearest`, at the point of the view that is first along its direction.
Rows project_along_view(const View& view, double first, double nearest) {
  Rows rows = focus(view);
  const glm::dvec4 length = rows.v - glm::dvec4(0.0, 0.0, 0.0, first);
  rows.w = length + glm::dvec4(0.0, 0.0, 0.0, nearest);
  rows.v = length;
  return rows;
}

struct Span {
  double first = std::numeric_limits<double>::max(), last = std::numeric_limits<double>::lowest();
  void add(double value) {
    first = std::min(first, value);
    last = std::max(last, value);
  }
  double length() const { return last - first; }
};

Span find_span(const std::vector<glm::dvec3>& points, const glm::dvec4& row) {
  Span span;
  for (const glm::dvec3& p : points) span.add(apply(row, p));
  return span;
}

glm::dvec3 find_middle(const std::vector<glm::dvec3>& points) {
  glm::dvec3 sum(0.0);
  for (const glm::dvec3& p : points) sum += p / static_cast<double>(points.size());
  return sum;
}

/// The camera's projection, its eye moved back, and then that of the lamp which the sun has become: of a point q behind
/// the camera's projection the lamp sees the part across its axis m. Written in (x, y, z, w) of the camera's clip space
/// with the sun at L = (l, L_w), u and v are q's parts across l, and w is q_w - (L_w / l.l) (l . q).
Rows project_from_camera(const View& view, double back_m) {
  const glm::dvec3 eye = view.eye - back_m * view.ahead;
  const glm::dvec3 right = glm::normalize(glm::cross(view.ahead, glm::dvec3(view.camera.up_ws)));
  const glm::dvec3 up = glm::cross(right, view.ahead);
  const double tangent = std::tan(0.5 * static_cast<double>(view.camera.vertical_fov_rad));
  const double near_m = view.depths.near_m + back_m, far_m = view.depths.far_m + back_m;
  const double range = std::max(far_m - near_m, 1e-6 * far_m);
  const std::array<glm::dvec4, 4> clip = {
      along(right, eye) / (tangent * view.aspect), along(up, eye) / tangent,
      (far_m + near_m) / range * along(view.ahead, eye) - glm::dvec4(0.0, 0.0, 0.0, 2.0 * far_m * near_m / range),
      along(view.ahead, eye)};
  const auto of_sun = [&](int row) { return glm::dot(glm::dvec3(clip[static_cast<std::size_t>(row)]), view.to_light); };
  const glm::dvec3 sun(of_sun(0), of_sun(1), of_sun(2));
  const glm::dmat3 axes = light_rotation(-glm::normalize(sun));
  const auto combine = [&](const glm::dvec3& axis) { return axis.x * clip[0] + axis.y * clip[1] + axis.z * clip[2]; };
  const glm::dmat3 rows = glm::transpose(axes);
  Rows found{combine(rows[0]), combine(rows[1]), clip[3] - of_sun(3) / glm::dot(sun, sun) * combine(sun)};
  // A camera that the sun shines at sees the map's plane from behind.
  const glm::dvec3 middle = find_middle(view.points);
  const auto slope = [&](const glm::dvec4& row) {
    return glm::dvec3(row - apply(row, middle) / apply(found.w, middle) * found.w);
  };
  if (glm::dot(glm::cross(slope(found.u), slope(found.v)), view.to_light) < 0.0) found.u = -found.u;
  return found;
}

Rows project_psm(const View& view) {
  const double wanted = kLeastNearShare * view.depths.near_m / view.depths.far_m;
  for (double back_m = 0.0; back_m < 1e3 * view.depths.far_m; back_m = 2.0 * back_m + 0.05 * view.depths.far_m) {
    const Rows rows = project_from_camera(view, back_m);
    const Span w = find_span(view.points, rows.w);
    if (w.first > wanted * w.last) return rows;
  }
  return focus(view);
}

/// n of the trapezoid whose first `focus` of a length gets 0.8 of the map: v(y) = (1 - n / (n + y)) (n + length) /
/// length is 0.8 at y = focus length.
double find_trapezoid_near(double length) {
  constexpr double kShare = 0.8;
  return kTrapezoidFocus * length * (1.0 - kShare) / (kShare - kTrapezoidFocus);
}

Rows choose_rows(const View& view, FitMode mode) {
  if (mode == FitMode::kFocused || !view.can_warp()) return focus(view);
  if (mode == FitMode::kPsm) return project_psm(view);
  const Span span = find_span(view.points, focus(view).v);
  const double near_m = view.depths.near_m;
  if (mode == FitMode::kTsm) return project_along_view(view, span.first, find_trapezoid_near(span.length()));
  if (mode == FitMode::kLogpsm) return project_along_view(view, span.first, near_m / view.sine);
  const double far_m = near_m + span.length() * view.sine;
  return project_along_view(view, span.first, (near_m + std::sqrt(near_m * far_m)) / view.sine);
}

/// How u or v, which run over `span` in what is seen, come to lie between the paddings of the map.
LogCurve fit_span(const Span& span, double used_share, double shift) {
  const double scale = used_share / std::max(span.length(), 1e-12);
  return {scale, 0.5 - 0.5 * scale * (span.first + span.last) + shift};
}

/// The lines of the light's plane on which u, or v, has a value: where this row is 0.
glm::dvec4 find_line(const glm::dvec4& row, const glm::dvec4& w, double value) { return row - value * w; }

/// A point where two such lines meet.
glm::dvec3 intersect(const View& view, const glm::dvec4& a, const glm::dvec4& b) {
  const glm::dvec3 origin = view.points.front();
  const auto along_axes = [&](const glm::dvec4& row) {
    return glm::dvec2(glm::dot(glm::dvec3(row), view.right), glm::dot(glm::dvec3(row), view.forward));
  };
  const glm::dmat2 rows = glm::transpose(glm::dmat2(along_axes(a), along_axes(b)));
  const glm::dvec2 steps = glm::inverse(rows) * -glm::dvec2(apply(a, origin), apply(b, origin));
  return origin + steps.x * view.right + steps.y * view.forward;
}

/// The map's corners on the light's plane: casters over what they enclose belong into it.
std::vector<glm::dvec3> list_corners(const View& view, const Rows& rows, const std::optional<LogCurve>& curve) {
  std::vector<glm::dvec3> corners;
  for (const double u : {0.0, 1.0}) {
    for (const double v : {0.0, 1.0}) {
      const glm::dvec4 across = find_line(rows.u, rows.w, u);
      const glm::dvec4 line = curve ? rows.w - glm::dvec4(0.0, 0.0, 0.0, std::exp((v - curve->offset) / curve->scale))
                                    : find_line(rows.v, rows.w, v);
      corners.push_back(intersect(view, across, line));
    }
  }
  return corners;
}

void set_rows(LightFrustum& fit, const Rows& rows) {
  const glm::dvec4 depth = -glm::transpose(fit.light_from_world)[2] / fit.depth_range_ws;
  const glm::dvec4 x = 2.0 * rows.u - rows.w, y = 2.0 * rows.v - rows.w;
  fit.clip_from_light = glm::transpose(glm::dmat4(x, y, depth, rows.w)) * glm::inverse(fit.light_from_world);
  fit.clip_from_world = glm::mat4(glm::transpose(glm::dmat4(x, y, glm::dvec4(0.0), rows.w)));  // never cut by depth
  fit.uv_depth_from_world = glm::mat4(glm::transpose(glm::dmat4(rows.u, rows.v, depth, rows.w)));
  fit.projective = true;
}

}  // namespace

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

LightFrustum fit_sun_over(const Sun& sun, const Scene& scene, const FitRequest& request,
                          const std::vector<glm::dvec3>& receivers) {
  const SunView view(sun, scene, request);
  return fit_box(view, box_over(receivers, scene, request, view), nullptr, request);
}

std::vector<LightFrustum> fit_sun(const Sun& sun, const MapWindow* window, const Scene& scene,
                                  const FitRequest& request) {
  if (request.mode == FitMode::kCascades && !window) return fit_cascades(sun, scene, request);
  if (is_warped(request.mode) && !window) return {fit_warped(sun, scene, request)};
  return {fit_whole(sun, window, scene, request)};
}

LightFrustum fit_warped(const Sun& sun, const Scene& scene, const FitRequest& request) {
  assert(request.camera);
  if (request.snap) {
    throw Error(ErrorKind::kUsage,
                "--snap on: the texels of a warped map change as the camera moves, and cannot keep to a grid; leave it "
                "out, or use --fit view or cascades");
  }
  const View view(sun, scene, request);
  if (view.points.empty()) return fit_sun_over(sun, scene, request, {});
  Rows rows = choose_rows(view, request.mode);
  const double used_share = count_used_texels(request) / request.map_size;
  const glm::dvec2 shift = request.shift_texels / static_cast<double>(request.map_size);
  Span u, v;
  const bool takes_log = request.mode == FitMode::kLogpsm && view.can_warp();
  for (const glm::dvec3& p : view.points) {
    const double w = apply(rows.w, p);
    u.add(apply(rows.u, p) / w);
    v.add(takes_log ? std::log(w) : apply(rows.v, p) / w);
  }
  const LogCurve along_u = fit_span(u, used_share, shift.x), along_v = fit_span(v, used_share, shift.y);
  rows.u = along_u.scale * rows.u + along_u.offset * rows.w;
  rows.v = along_v.scale * rows.v + along_v.offset * rows.w;
  std::optional<LogCurve> curve;
  if (takes_log) curve = along_v;

  std::vector<glm::dvec3> covered = list_corners(view, rows, curve);
  covered.insert(covered.end(), view.points.begin(), view.points.end());
  LightFrustum fit = fit_sun_over(sun, scene, request, covered);
  fit.shape = curve ? MapShape::kLogarithmic : MapShape::kWarped;
  fit.log_curve = curve.value_or(LogCurve{});
  set_rows(fit, rows);
  fit.texel_size_ws = 1.0;
  fit.width_ws = request.map_size;
  fit.texel_size_ws = fit.texel_size_at(find_middle(view.points));
  fit.width_ws = fit.texel_size_ws * request.map_size;
  return fit;
}

}  // namespace shadowbench::scene
