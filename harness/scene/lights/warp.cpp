#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <limits>
#include <optional>

#include "base/error.h"
#include "harness/scene/lights/light_fit.h"

namespace shadowbench::scene {
namespace {

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
