#include "harness/stress/stored_depths.h"

#include <algorithm>
#include <cmath>

#include "harness/stress/filter_bench.h"

namespace shadowbench::stress {
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
