#include "harness/stress/tilted_plane.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace shadowbench::stress {
namespace {

constexpr int kReceivers = 64;          // along each axis
constexpr double kStep_texels = 0.628;  // between them: meets every place within a texel
constexpr double kLeastAcne = 1e-6;     // mean shadow: one receiver by 1/256
constexpr double kRoundings = 8.0;      // of a depth, on its way into the map and from the receiver

double tangent(const PlaneTilt& tilt) { return std::tan(tilt.angle_deg * std::numbers::pi / 180.0); }

/// What the light sees of the plane, with a margin.
double find_depth_range_m(const PlaneTilt& tilt) { return std::max(2.0 * tangent(tilt), 1e-3); }

/// The light's axes: along the map's rows and columns, and away from it. The plane is y = 0.
struct LightAxes {
  glm::dvec3 right, up, away;
};

LightAxes make_axes(const PlaneTilt& tilt) {
  const double angle = tilt.angle_deg * std::numbers::pi / 180.0;
  const glm::dvec3 falling(std::cos(angle), std::sin(angle), 0.0), level(0.0, 0.0, 1.0),
      away(std::sin(angle), -std::cos(angle), 0.0);
  if (!tilt.diagonal) return {falling, level, away};
  return {(falling + level) / std::numbers::sqrt2, (level - falling) / std::numbers::sqrt2, away};
}

/// The point of the plane that a place on the map, metres from its middle, shows.
glm::dvec3 find_point(const PlaneTilt& tilt, const glm::dvec2& place) {
  const LightAxes axes = make_axes(tilt);
  const glm::dvec3 seen = place.x * axes.right + place.y * axes.up;
  return seen - axes.away * (seen.y / axes.away.y);
}

/// The receivers, metres from the map's middle.
std::vector<glm::dvec2> place_receivers() {
  std::vector<glm::dvec2> places;
  const auto place = [](int i) { return (i - 0.5 * (kReceivers - 1)) * kStep_texels * kPlaneTexel_m; };
  for (int y = 0; y < kReceivers; ++y)
    for (int x = 0; x < kReceivers; ++x) places.emplace_back(place(x), place(y));
  return places;
}

scene::LightFrustum make_plane_frustum(const PlaneTilt& tilt) {
  const LightAxes axes = make_axes(tilt);
  scene::LightFrustum frustum = make_axis_frustum(1.0, kPlaneMapTexels);
  frustum.depth_range_ws = find_depth_range_m(tilt);
  frustum.direction_ws = glm::vec3(axes.away);
  frustum.light_from_world = glm::transpose(glm::dmat4(glm::dvec4(axes.right, 0.0), glm::dvec4(axes.up, 0.0),
                                                       glm::dvec4(-axes.away, 0.0), glm::dvec4(0.0, 0.0, 0.0, 1.0)));
  const double depth = -1.0 / frustum.depth_range_ws;
  frustum.clip_from_light = glm::dmat4(glm::dvec4(2.0, 0.0, 0.0, 0.0), glm::dvec4(0.0, 2.0, 0.0, 0.0),
                                       glm::dvec4(0.0, 0.0, depth, 0.0), glm::dvec4(0.0, 0.0, 0.5, 1.0));
  const glm::dmat4 uv_from_light(glm::dvec4(1.0, 0.0, 0.0, 0.0), glm::dvec4(0.0, 1.0, 0.0, 0.0),
                                 glm::dvec4(0.0, 0.0, depth, 0.0), glm::dvec4(0.5, 0.5, 0.5, 1.0));
  frustum.clip_from_world = glm::mat4(frustum.clip_from_light * frustum.light_from_world);
  frustum.uv_depth_from_world = glm::mat4(uv_from_light * frustum.light_from_world);
  return frustum;
}

/// Makes the plane, larger than the map on every side.
scene::Scene make_plane_scene(const PlaneTilt& tilt) {
  scene::Scene scene;
  scene.materials.emplace_back();
  scene::Mesh mesh;
  for (const auto& [x, y] : {std::pair(-0.6, -0.6), {0.6, -0.6}, {0.6, 0.6}, {-0.6, 0.6}})
    mesh.vertices.push_back({glm::vec3(find_point(tilt, {x, y})), {0.0f, 1.0f, 0.0f}, {}});
  mesh.indices = {0, 1, 2, 0, 2, 3};
  scene.meshes.push_back(std::move(mesh));
  return scene;
}

Acne measure(const std::vector<float>& visibility) {
  constexpr double kStep = 1.0 / 255.0;
  Acne acne;
  for (const float v : visibility) {
    const double shadow = 1.0 - static_cast<double>(v);
    acne.mean_shadow += shadow / static_cast<double>(visibility.size());
    if (shadow >= kStep) acne.share += 1.0 / static_cast<double>(visibility.size());
  }
  return acne;
}

}  // namespace

double find_gain_m(const PlaneTilt& tilt, double reach_texels) {
  return reach_texels * kPlaneTexel_m * tangent(tilt) * (tilt.diagonal ? std::numbers::sqrt2 : 1.0);
}

double TiltedPlane::rounding_m() const { return kRoundings * 0x1p-24 * find_depth_range_m(tilt_); }

void TiltedPlane::tilt(const PlaneTilt& tilt) {
  tilt_ = tilt;
  bench_.resize({kPlaneMapTexels, kReceivers, kReceivers});
  bench_.map().draw(bench_.shaders(), render::Geometry(make_plane_scene(tilt)), make_plane_frustum(tilt));
  std::vector<glm::vec3> receivers;
  for (const glm::dvec2& place : place_receivers()) receivers.emplace_back(find_point(tilt, place));
  bench_.upload_receivers(receivers, {0.0f, 1.0f, 0.0f});
}

Acne TiltedPlane::find_acne(double bias_m) {
  const scene::LightFrustum frustum = make_plane_frustum(tilt_);
  render::Bias bias;
  bias.constant_depth = bias_m / frustum.depth_range_ws;
  return measure(bench_.look_up({frustum, 0.0, bias, seed_, {}}, bench_.request().values));
}

std::optional<double> TiltedPlane::find_needed_bias(double theory_m) {
  const auto has_acne = [&](double bias_m) { return find_acne(bias_m).mean_shadow > kLeastAcne; };
  if (!has_acne(0.0)) return 0.0;
  double low = 0.0, high = 2.0 * theory_m + rounding_m();
  if (has_acne(high)) return std::nullopt;
  while (high - low > 1e-3 * high) {
    const double middle = 0.5 * (low + high);
    (has_acne(middle) ? low : high) = middle;
  }
  return high;
}

}  // namespace shadowbench::stress
