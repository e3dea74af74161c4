#include "harness/stress/drawn_maps.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "harness/stress/synthetic_scene.h"

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

namespace {

constexpr int kSize = 64;  // of the texture
constexpr int kCount = kSize * kSize;
constexpr int kPerQuantum = 128;  // depths that are tried at a plane

filters::DepthFormat describe(GLenum format) {
  const bool is_float = format == GL_DEPTH_COMPONENT32F;
  return {is_float ? 32 : format == GL_DEPTH_COMPONENT24 ? 24 : 16, is_float};
}

filters::DepthCurve make_curve(const DepthPlan& plan) {
  return {plan.reversed, plan.perspective ? plan.far_over_near : 1.0};
}

/// Places a third of the depths over the range, at equal ratios of distance, and a third within some quanta of each
/// end.
std::vector<double> place_depths(const DepthPlan& plan, double quantum) {
  std::vector<double> depths;
  for (int i = 0; i < kCount; ++i) {
    const int third = kCount / 3, k = i % third;
    const double from_end = k * quantum / kPerQuantum;
    if (i < third)
      depths.push_back(from_end);
    else if (i < 2 * third)
      depths.push_back(1.0 - from_end);
    else
      depths.push_back(depth_of(plan, std::pow(plan.far_over_near, static_cast<double>(k % third) / third)));
  }
  return depths;
}

/// Makes a square for every texel, at its depth. World and clip space of the light are the same, so that the depth that
/// is drawn is this one, as a 32-bit float.
scene::Scene make_squares(const std::vector<double>& depths) {
  scene::Scene scene;
  scene.materials.emplace_back();
  scene::Mesh mesh;
  for (int i = 0; i < kCount; ++i) {
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    for (const auto& [dx, dy] : {std::pair(0, 0), {1, 0}, {1, 1}, {0, 1}}) {
      mesh.vertices.push_back({{2.0f * static_cast<float>(i % kSize + dx) / kSize - 1.0f,
                                2.0f * static_cast<float>(i / kSize + dy) / kSize - 1.0f,
                                static_cast<float>(depths[static_cast<std::size_t>(i)])},
                               {0.0f, 0.0f, -1.0f},
                               {}});
    }
    for (const std::uint32_t corner : {0u, 1u, 2u, 0u, 2u, 3u}) mesh.indices.push_back(first + corner);
  }
  scene.meshes.push_back(std::move(mesh));
  return scene;
}

}  // namespace

double depth_of(const DepthPlan& plan, double distance) {
  return make_curve(plan).store((distance - 1.0) / (plan.far_over_near - 1.0));
}

double distance_of(const DepthPlan& plan, double depth) {
  return 1.0 + make_curve(plan).linear(depth) * (plan.far_over_near - 1.0);
}

double largest_rounding(GLenum format, double depth) {
  return 0.5 * filters::depth_quantum(std::nextafter(depth, 0.0), describe(format));
}

double find_distance_error(GLenum format, const DepthPlan& plan, double distance) {
  const double ratio = plan.far_over_near,
               slope = plan.perspective ? distance * distance * (ratio - 1.0) / ratio : ratio - 1.0;
  return slope * largest_rounding(format, depth_of(plan, distance));
}

std::vector<double> StoredDepths::keep(const std::vector<double>& depths) {
  if (!map_) map_.emplace(kSize, render::MapSettings{format_, {}});
  map_->draw(shaders_, render::Geometry(make_squares(depths)), make_axis_frustum(2.0, kSize));
  const std::vector<float> read = map_->texture().read_floats(1);
  std::vector<double> kept(read.begin(), read.end());
  if (format_ == GL_DEPTH_COMPONENT32F) return kept;
  // Reading rounds to a float once more; the code that is stored has survived that.
  const double codes = std::exp2(describe(format_).bits) - 1.0;
  for (double& depth : kept) depth = std::round(depth * codes) / codes;
  return kept;
}

DepthError StoredDepths::find_largest_error(const DepthPlan& plan) {
  const double quantum = format_ == GL_DEPTH_COMPONENT32F ? 0x1p-24 : filters::depth_quantum(0.0, describe(format_));
  const std::vector<double> depths = place_depths(plan, quantum), kept = keep(depths);
  DepthError largest;
  for (std::size_t i = 0; i < kept.size(); ++i) {
    const double distance = distance_of(plan, depths[i]),
                 relative = std::abs(distance_of(plan, kept[i]) / distance - 1.0);
    if (!(relative <= largest.relative)) largest = {relative, distance};
  }
  return largest;
}

double StoredDepths::find_error_around(const DepthPlan& plan, double distance) {
  const double middle = depth_of(plan, distance), step = 2.0 * largest_rounding(format_, middle) / kPerQuantum;
  std::vector<double> depths;
  for (int i = 0; i < kCount; ++i) depths.push_back(std::clamp(middle + (i - kCount / 2) * step, 0.0, 1.0));
  const std::vector<double> kept = keep(depths);
  double largest = 0.0;
  for (std::size_t i = 0; i < kept.size(); ++i)
    largest = std::max(largest, std::abs(distance_of(plan, kept[i]) - distance_of(plan, depths[i])));
  return largest;
}

}  // namespace shadowbench::stress
