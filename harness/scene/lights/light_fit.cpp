#include "harness/scene/lights/light_fit.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <functional>
#include <glm/gtx/component_wise.hpp>
#include <iterator>
#include <limits>
#include <span>

#include "base/error.h"
#include "base/text.h"
#include "harness/scene/mesh_tools.h"

namespace shadowbench::scene {
namespace {

constexpr std::array<std::string_view, 10> kFitNames = {"sphere", "tight", "view",   "cascades",  "focused", "lispsm",
                                                        "psm",    "tsm",   "logpsm", "paraboloid"};  // as FitMode

constexpr int kMostCascades = 4;
constexpr double kLeastMetres = 1e-3, kMostMetres = 1e6;

[[noreturn]] void refuse(const std::string& message) { throw Error(ErrorKind::kUsage, "--fit: " + message); }

double read_number(std::string_view key, std::string_view text, double least, double most, const char* words = "") {
  const std::optional<double> number = parse_number(text);
  if (number && *number >= least && *number <= most) return *number;
  refuse(fmt::format("{} is '{}' and must be {} .. {}{}", key, text, least, most, words));
}

double read_split(std::string_view text) {
  if (text == "uniform") return 0.0;
  if (text == "practical") return 0.5;
  if (text == "logarithmic") return 1.0;
  return read_number("split", text, 0.0, 1.0, ", or uniform (0), practical (0.5) or logarithmic (1)");
}

double read_metres(std::string_view key, std::string_view text) {
  return read_number(key, text, kLeastMetres, kMostMetres, " metres");
}

std::vector<double> read_splits(std::string_view text) {
  std::vector<double> splits;
  for (const std::string& each : split_list(std::string(text), "/")) splits.push_back(read_metres("splits", each));
  if (splits.empty() || splits.size() + 1 > kMostCascades)
    refuse(
        fmt::format("splits is '{}' and must be 1 to {} depths in metres, as in splits=5/20", text, kMostCascades - 1));
  return splits;
}

void set_key(CascadeRule& rule, std::string_view key, std::string_view value) {
  if (key == "count") {
    const double count = read_number(key, value, 2.0, kMostCascades);
    rule.count = static_cast<int>(count);
    if (rule.count != count) refuse(fmt::format("count is '{}' and must be a whole number", value));
  } else if (key == "split") {
    rule.split = read_split(value);
  } else if (key == "splits") {
    rule.splits = read_splits(value);
  } else if (key == "near") {
    rule.near_m = read_metres(key, value);
  } else if (key == "far") {
    rule.far_m = read_metres(key, value);
  } else if (key == "blend") {
    rule.blend = read_number(key, value, 0.0, 0.5);
  } else if (key == "depths") {
    if (value != "all" && value != "seen") refuse(fmt::format("depths is '{}' and must be all or seen", value));
    rule.seen = value == "seen";
  } else {
    refuse(
        fmt::format("cascades have no '{}'; they have count, split, splits, near, far, blend and depths, e.g. "
                    "cascades:count=3,split=logarithmic or cascades:splits=5/20,far=80",
                    key));
  }
}

void require_ascent(const CascadeRule& rule) {
  std::vector<double> depths = rule.splits;
  if (rule.near_m > 0.0) depths.insert(depths.begin(), rule.near_m);
  if (rule.far_m > 0.0) depths.push_back(rule.far_m);
  const auto fall = std::ranges::adjacent_find(depths, std::greater_equal());
  if (fall != depths.end())
    refuse(fmt::format("{} m follows {} m: near, splits and far must ascend", *std::next(fall), *fall));
}

/// Holds splits in metres against the keys that say how many slices there are, and in which ratio.
void take_splits(CascadeRule& rule, const std::set<std::string>& keys) {
  if (keys.contains("split")) refuse("split and splits are both given: splits are metres, and leave nothing to split");
  const int count = static_cast<int>(rule.splits.size()) + 1;
  if (keys.contains("count") && rule.count != count)
    refuse(fmt::format("{} splits make {} cascades, not {}: leave count out", count - 1, count, rule.count));
  rule.count = count;
}

CascadeRule parse_cascades(std::string_view text) {
  CascadeRule rule;
  std::set<std::string> keys;
  for (const auto& [key, value] : split_assignments(text, "--fit")) {
    set_key(rule, key, value);
    keys.insert(key);
  }
  if (!rule.splits.empty()) take_splits(rule, keys);
  require_ascent(rule);
  return rule;
}

/// A direction as a paraboloid sees it: along the light's right and up, and along its axis.
struct Ray {
  double distance_m;
  glm::dvec3 direction_ws, right_ws, up_ws, axis_ws;
  double x, y, along;
};

Ray find_ray(const LightFrustum& frustum, const glm::dvec3& point_ws) {
  const glm::dmat4 rows = glm::transpose(frustum.light_from_world);
  Ray ray{glm::distance(point_ws, frustum.perspective->beam.position_ws),
          glm::normalize(point_ws - frustum.perspective->beam.position_ws),
          glm::dvec3(rows[0]),
          glm::dvec3(rows[1]),
          frustum.perspective->beam.axis_ws,
          0.0,
          0.0,
          0.0};
  ray.x = glm::dot(ray.direction_ws, ray.right_ws);
  ray.y = glm::dot(ray.direction_ws, ray.up_ws);
  ray.along = glm::dot(ray.direction_ws, ray.axis_ws);
  return ray;
}

truth::TexelGradients find_paraboloid_gradients(const LightFrustum& frustum, const glm::dvec3& point_ws) {
  const Ray ray = find_ray(frustum, point_ws);
  const glm::dvec3 towards_axis = (ray.axis_ws - ray.along * ray.direction_ws) / (1.0 + ray.along);
  const double scale = frustum.map_texels() * frustum.paraboloid.radius / ((1.0 + ray.along) * ray.distance_m);
  return {scale * (ray.right_ws - ray.x * ray.direction_ws - ray.x * towards_axis),
          scale * (ray.up_ws - ray.y * ray.direction_ws - ray.y * towards_axis)};
}

/// A step along the light's axis changes nothing under the sun; under a lamp it moves a place towards the map's middle.
truth::TexelGradients find_plane_gradients(const LightFrustum& frustum, const glm::dvec3& point_ws) {
  const glm::dmat4 rows = glm::transpose(frustum.light_from_world);
  const double texel = frustum.texel_size_at(point_ws);
  truth::TexelGradients along{glm::dvec3(rows[0]) / texel, glm::dvec3(rows[1]) / texel};
  if (!frustum.perspective) return along;
  const Beam& beam = frustum.perspective->beam;
  const glm::dvec3 way = point_ws - beam.position_ws,
                   per_metre = beam.axis_ws / frustum.perspective->distance(point_ws);
  along.u -= glm::dot(along.u, way) * per_metre;
  along.v -= glm::dot(along.v, way) * per_metre;
  return along;
}

/// Where a point lies in a curved map: u and v in [0,1], and depth.
glm::dvec3 find_in_curved_map(const LightFrustum& frustum, const glm::dvec3& point_ws) {
  if (frustum.shape == MapShape::kParaboloid) {
    const Ray ray = find_ray(frustum, point_ws);
    const double scale = frustum.paraboloid.radius / (1.0 + ray.along);
    const glm::dvec2& center = frustum.paraboloid.center;
    return {center.x + scale * ray.x, center.y + scale * ray.y,
            (ray.distance_m - frustum.perspective->near_m) / frustum.depth_range_ws};
  }
  const glm::dvec4 seen = frustum.light_from_world * glm::dvec4(point_ws, 1.0), clip = frustum.clip_from_light * seen;
  const double v = frustum.shape == MapShape::kLogarithmic
                       ? frustum.log_curve.scale * std::log(clip.w) + frustum.log_curve.offset
                       : 0.5 + 0.5 * clip.y / clip.w;
  return {0.5 + 0.5 * clip.x / clip.w, v, -seen.z / frustum.depth_range_ws};
}

/// All that the gradients depend on, as text.
std::string name_shape(const LightFrustum& frustum) {
  const glm::dmat4 clip_from_world = frustum.clip_from_light * frustum.light_from_world;
  return fmt::format("shape {} {} {} {} {} {}", static_cast<int>(frustum.shape), frustum.map_texels(),
                     frustum.paraboloid.radius, frustum.log_curve.scale, frustum.layer,
                     fmt::join(std::span(&clip_from_world[0][0], 16), " "));
}

/// Depth is computed in float, and a near plane at the lamp would leave none of it for the scene.
PerspectiveMap make_planes(const Beam& beam, const AxisExtent& extent) {
  constexpr double kPadding = 1e-3, kLeastNear = 1.0 / 500.0;
  if (extent.farthest <= 0.0) return {beam, 0.5 * beam.reference_m, 2.0 * beam.reference_m};
  const double far_m = extent.farthest * (1.0 + kPadding);
  return {beam, std::max(extent.nearest * (1.0 - kPadding), kLeastNear * far_m), far_m};
}

/// Whether two layers serve the same receivers, but for rounding: a camera's place is in single precision.
bool is_alike(const LayerShare& a, const LayerShare& b) {
  const auto *one = std::get_if<ViewSlice>(&a), *other = std::get_if<ViewSlice>(&b);
  if (!one || !other) return a == b;
  const auto is_near = [](double x, double y) { return std::abs(x - y) <= 1e-4 * std::abs(x); };
  return is_near(one->fade_in_begin, other->fade_in_begin) && is_near(one->fade_in_end, other->fade_in_end) &&
         is_near(one->fade_out_begin, other->fade_out_begin) && is_near(one->fade_out_end, other->fade_out_end);
}

/// A plane; points with dot(normal, p) + offset >= 0 are inside.
struct HalfSpace {
  glm::dvec3 normal;
  double offset;
  double distance(const glm::dvec3& p) const { return glm::dot(normal, p) + offset; }
};

std::vector<HalfSpace> bound_view(const Camera& camera, double aspect, const std::optional<DepthSpan>& span) {
  const auto [eye, forward, right, up, half_height, tangent] = ViewAxes(camera);
  std::vector<HalfSpace> bounds;
  const auto add = [&bounds, &eye = eye](const glm::dvec3& normal, double offset) {
    bounds.push_back({normal, offset - glm::dot(normal, eye)});
  };
  for (const double side : {-1.0, 1.0}) {
    add(side * right + (half_height > 0.0 ? 0.0 : tangent * aspect) * forward, half_height * aspect);
    add(side * up + (half_height > 0.0 ? 0.0 : tangent) * forward, half_height);
  }
  if (!(half_height > 0.0)) add(forward, 0.0);
  if (span) {
    add(forward, -span->near_m);
    add(-forward, span->far_m);
  }
  return bounds;
}

using Polygon = std::vector<glm::dvec3>;

Polygon cut(const Polygon& polygon, const HalfSpace& bound) {
  Polygon kept;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const glm::dvec3 &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
    const double da = bound.distance(a), db = bound.distance(b);
    if (da >= 0.0) kept.push_back(a);
    if ((da >= 0.0) != (db >= 0.0)) kept.push_back(a + (b - a) * (da / (da - db)));
  }
  return kept;
}

}  // namespace

std::vector<std::string> list_fit_names() { return {kFitNames.begin(), kFitNames.end()}; }

std::string_view name_of(FitMode mode) { return kFitNames[static_cast<std::size_t>(mode)]; }

std::string describe_fit(const FitRule& rule) {
  if (rule.mode != FitMode::kCascades) return std::string(name_of(rule.mode));
  const CascadeRule& cascades = rule.cascades;
  const std::string split = cascades.splits.empty() ? fmt::format("split={}", cascades.split)
                                                    : fmt::format("splits={}", fmt::join(cascades.splits, "/"));
  std::string text = fmt::format("cascades:count={},{},blend={},depths={}", cascades.count, split, cascades.blend,
                                 cascades.seen ? "seen" : "all");
  if (cascades.near_m > 0.0) text += fmt::format(",near={}", cascades.near_m);
  if (cascades.far_m > 0.0) text += fmt::format(",far={}", cascades.far_m);
  return text;
}

std::set<std::string> describe_fits(const std::vector<FitRule>& rules) {
  std::set<std::string> all;
  for (const FitRule& rule : rules) all.insert(describe_fit(rule));
  return all;
}

FitRule parse_fit_rule(std::string_view text) {
  const std::string_view name = text.substr(0, text.find(':'));
  const auto found = std::find(kFitNames.begin(), kFitNames.end(), name);
  if (found == kFitNames.end()) refuse(fmt::format("unknown fit '{}'; there are {}", name, fmt::join(kFitNames, ", ")));
  FitRule rule{static_cast<FitMode>(found - kFitNames.begin()), {}};
  if (name.size() == text.size()) return rule;
  if (rule.mode != FitMode::kCascades) refuse(fmt::format("'{}' takes no values; only cascades do", name));
  rule.cascades = parse_cascades(text.substr(name.size() + 1));
  return rule;
}

truth::TexelGradients find_gradients(const LightFrustum& frustum, const glm::dvec3& point_ws) {
  if (frustum.shape == MapShape::kParaboloid) return find_paraboloid_gradients(frustum, point_ws);
  if (frustum.shape == MapShape::kPlane) return find_plane_gradients(frustum, point_ws);
  const glm::dmat4 clip_from_world = frustum.clip_from_light * frustum.light_from_world;
  const glm::dmat4 rows = glm::transpose(clip_from_world);
  const glm::dvec4 clip = clip_from_world * glm::dvec4(point_ws, 1.0);
  const auto along = [&](int row) {
    return (0.5 * frustum.map_texels() / clip.w) * glm::dvec3(rows[row] - (clip[row] / clip.w) * rows[3]);
  };
  if (frustum.shape != MapShape::kLogarithmic) return {along(0), along(1)};
  return {along(0), (frustum.map_texels() * frustum.log_curve.scale / clip.w) * glm::dvec3(rows[3])};
}

glm::dvec3 LightFrustum::to_light(const glm::dvec3& point_ws) const {
  return perspective ? glm::normalize(perspective->beam.position_ws - point_ws) : -glm::dvec3(direction_ws);
}

double LightFrustum::texel_size_at(const glm::dvec3& point_ws) const {
  if (is_curved(shape)) {
    const truth::TexelGradients along = find_gradients(*this, point_ws);
    return 1.0 / std::sqrt(glm::length(glm::cross(along.u, along.v)));
  }
  return perspective ? texel_size_ws * perspective->distance(point_ws) / perspective->beam.reference_m : texel_size_ws;
}

glm::dvec3 LightFrustum::place(const glm::dvec3& point_ws, int map_size) const {
  if (is_curved(shape)) return find_in_curved_map(*this, point_ws) * glm::dvec3(map_size, map_size, 1.0);
  const glm::dvec4 seen = light_from_world * glm::dvec4(point_ws, 1.0);
  if (!perspective)
    return {seen.x / texel_size_ws + 0.5 * map_size, seen.y / texel_size_ws + 0.5 * map_size, -seen.z / depth_range_ws};
  const glm::dvec4 clip = clip_from_light * seen;
  return {(0.5 + 0.5 * clip.x / clip.w) * map_size, (0.5 + 0.5 * clip.y / clip.w) * map_size,
          (-seen.z - perspective->near_m) / depth_range_ws};
}

glm::dmat3 light_rotation(const glm::dvec3& direction) {
  const glm::dvec3 back = -direction;
  const glm::dvec3 right = glm::normalize(glm::cross(axis_least_parallel(direction), back));
  return glm::transpose(glm::dmat3(right, glm::cross(back, right), back));
}

double count_used_texels(const FitRequest& request) {
  const double used = request.map_size - 2.0 * request.pad_texels - (request.snap ? 1.0 : 0.0);
  if (used >= 1.0) return used;
  throw Error(ErrorKind::kUsage,
              fmt::format("a map of {} texels has no room for a kernel of {} texels on every side{}; "
                          "use a larger map or a smaller radius",
                          request.map_size, request.pad_texels, request.snap ? " and a texel to snap" : ""));
}

void set_perspective(LightFrustum& frustum, double tangent, const glm::dvec2& shift_clip) {
  const double near_m = frustum.perspective->near_m, far_m = frustum.perspective->far_m, range = far_m - near_m;
  glm::dmat4& clip = frustum.clip_from_light = glm::dmat4(0.0);
  clip[0][0] = clip[1][1] = 1.0 / tangent;
  clip[2] = glm::dvec4(shift_clip, -far_m / range, -1.0);  // w is the distance along the axis
  clip[3][2] = -far_m * near_m / range;
  frustum.clip_from_world = glm::mat4(clip * frustum.light_from_world);
  glm::dmat4 uv_depth = clip;
  for (int column = 0; column < 4; ++column)
    for (int row = 0; row < 2; ++row) uv_depth[column][row] = 0.5 * (clip[column][row] + clip[column][3]);
  for (int column = 0; column < 4; ++column) uv_depth[column][2] = 0.0;
  uv_depth[2][2] = -1.0 / range;
  uv_depth[3][2] = -near_m / range;
  frustum.uv_depth_from_world = glm::mat4(uv_depth * frustum.light_from_world);
}

truth::MapGrid make_map_grid(const LightFrustum& frustum) {
  const glm::dmat4 rows = glm::transpose(frustum.light_from_world);
  truth::MapGrid grid{
      -glm::dvec3(frustum.direction_ws), glm::dvec3(rows[0]), glm::dvec3(rows[1]), frustum.texel_size_ws, {}, {}};
  if (frustum.perspective)
    grid.lamp = truth::MapGrid::Lamp{frustum.perspective->beam.position_ws, frustum.perspective->beam.reference_m};
  if (is_curved(frustum.shape)) {
    grid.curved = truth::MapGrid::Curved{[frustum](const glm::dvec3& p) { return find_gradients(frustum, p); },
                                         name_shape(frustum)};
  }
  return grid;
}

LightFrustum fit_light(const Scene& scene, FitMode mode, int map_size, double pad_texels) {
  return fit_light(scene, FitRequest{.mode = mode, .map_size = map_size, .pad_texels = pad_texels});
}

LightFrustum fit_light(const Scene& scene, const FitRequest& request) {
  std::vector<LightFrustum> layers = fit_layers(scene, request);
  assert(layers.size() == 1);
  return std::move(layers.front());
}

bool follows_camera(const Light& light, const FitRule& rule) {
  return rule.follows_view() && !light.map_window && !find_beam(light);
}

bool has_same_grid(const LightFrustum& a, const LightFrustum& b) {
  constexpr double kRounding = 1e-6;  // of a texel
  if (is_curved(a.shape) || is_curved(b.shape) || !is_alike(a.share, b.share)) return false;
  if (std::abs(a.texel_size_ws - b.texel_size_ws) > kRounding * a.texel_size_ws) return false;
  const glm::dvec2 moved = glm::dvec2(a.light_from_world[3] - b.light_from_world[3]) / a.texel_size_ws;
  return glm::compMax(glm::abs(moved - glm::round(moved))) < kRounding;
}

AxisExtent AxisExtent::joined(const AxisExtent& other) const {
  if (farthest <= 0.0) return other;
  if (other.farthest <= 0.0) return *this;
  return {std::min(nearest, other.nearest), std::max(farthest, other.farthest)};
}

AxisExtent find_extent(const Scene& scene, const glm::dmat4& light_from_world, double tangent) {
  AxisExtent extent;
  const auto see = [&](const glm::vec3& p) { return glm::dvec3(light_from_world * glm::dvec4(p, 1.0)); };
  for (const Mesh& mesh : scene.meshes) {
    for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
      glm::dvec3 least(std::numeric_limits<double>::max()), most(std::numeric_limits<double>::lowest());
      for (std::size_t k = 0; k < 3; ++k) {
        const glm::dvec3 seen = see(mesh.vertices[mesh.indices[i + k]].position_ws);
        least = glm::min(least, seen);
        most = glm::max(most, seen);
      }
      const double reach = -least.z * tangent;  // half of the square where it is widest over this triangle
      if (-least.z <= 0.0 || least.x > reach || most.x < -reach || least.y > reach || most.y < -reach) continue;
      extent = extent.joined({std::max(-most.z, 0.0), -least.z});
    }
  }
  return extent;
}

glm::dmat4 look_along(const Beam& beam) {
  const glm::dmat3 rotation = light_rotation(beam.axis_ws);
  glm::dmat4 light_from_world(rotation);
  light_from_world[3] = glm::dvec4(-(rotation * beam.position_ws), 1.0);
  return light_from_world;
}

double pad_tangent(double tangent, const FitRequest& request) {
  return tangent * request.map_size / count_used_texels(request);
}

LightFrustum fit_perspective(const Beam& beam, double tangent, const AxisExtent& extent, const FitRequest& request) {
  LightFrustum fit;
  fit.light_from_world = look_along(beam);
  fit.perspective = make_planes(beam, extent);
  fit.projective = true;
  fit.direction_ws = glm::vec3(beam.axis_ws);
  fit.width_ws = 2.0 * tangent * beam.reference_m;
  fit.texel_size_ws = fit.width_ws / request.map_size;
  fit.depth_range_ws = fit.perspective->far_m - fit.perspective->near_m;
  set_perspective(fit, tangent, 2.0 * request.shift_texels / static_cast<double>(request.map_size));
  return fit;
}

double view_depth(const Camera& camera, const glm::dvec3& point_ws) {
  return glm::dot(point_ws - glm::dvec3(camera.position_ws), glm::dvec3(camera.forward_ws));
}

DepthSpan find_depth_span(const Camera& camera, const std::vector<glm::dvec3>& points) {
  DepthSpan span{std::numeric_limits<double>::max(), 0.0};
  for (const glm::dvec3& p : points) {
    const double depth = view_depth(camera, p);
    span = {std::min(span.near_m, depth), std::max(span.far_m, depth)};
  }
  return span;
}

ViewCorners list_view_corners(const Camera& camera, double aspect, const DepthSpan& span) {
  const ViewAxes axes(camera);
  ViewCorners corners;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const double depth = i < 4 ? span.near_m : span.far_m;
    const double half = axes.half_height > 0.0 ? axes.half_height : axes.tangent * depth;
    corners[i] = axes.eye + depth * axes.forward + (i % 2 ? half : -half) * aspect * axes.right +
                 (i / 2 % 2 ? half : -half) * axes.up;
  }
  return corners;
}

std::vector<glm::dvec3> list_visible_corners(const Scene& scene, const Camera& camera, double aspect,
                                             const std::optional<DepthSpan>& span) {
  const std::vector<HalfSpace> bounds = bound_view(camera, aspect, span);
  std::vector<glm::dvec3> corners;
  for (const Mesh& mesh : scene.meshes) {
    for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
      Polygon polygon;
      for (std::size_t k = 0; k < 3; ++k) polygon.emplace_back(mesh.vertices[mesh.indices[i + k]].position_ws);
      for (const HalfSpace& bound : bounds)
        if (!polygon.empty()) polygon = cut(polygon, bound);
      corners.insert(corners.end(), polygon.begin(), polygon.end());
    }
  }
  return corners;
}

}  // namespace shadowbench::scene
