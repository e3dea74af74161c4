#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "harness/stress/axis.h"
#include "harness/stress/synthetic_scene.h"

namespace shadowbench::stress {
namespace depth_formats {

constexpr double kBound = 0.01;  // of a distance
constexpr double kBroken = 0.5;
constexpr const char* kSource =
    "derived from OpenGL 4.5 core specification, sections 2.3.5 (fixed point) and 13.6 (depth): d^2 (f - n) / (n f) "
    "times half a quantum, over d";

struct Setting {
  GLenum format;
  bool perspective;
  bool reversed;
};

std::string name(const Setting& setting) {
  const char* format = setting.format == GL_DEPTH_COMPONENT16   ? "D16"
                       : setting.format == GL_DEPTH_COMPONENT24 ? "D24"
                                                                : "D32F";
  return fmt::format("{}, {}{}", format, setting.perspective ? "perspective" : "orthographic",
                     setting.reversed ? ", reversed" : "");
}

filters::DepthFormat describe(GLenum format) {
  const bool is_float = format == GL_DEPTH_COMPONENT32F;
  return {is_float ? 32 : format == GL_DEPTH_COMPONENT24 ? 24 : 16, is_float};
}

/// Gives half a quantum of the depth that is stored where the relative error, (f/n - 1) times that, is largest: at the
/// near plane of an orthographic light, where a distance is smallest; at the far plane of a perspective one, where a
/// step is largest.
double find_quantum(const Setting& setting) {
  const bool stores_one = setting.perspective != setting.reversed;
  return 0.5 * filters::depth_quantum(std::nextafter(stores_one ? 1.0 : 0.0, 0.0), describe(setting.format));
}

Theory make_theory(const Setting& setting, double error, Verdict predicts) {
  const double rounding = find_quantum(setting);
  const char* where = setting.perspective ? "far" : "near";
  if (rounding < 0x1p-40) {
    return {std::nullopt, TheoryKind::kQuantum,
            fmt::format("none: a float is finest where it is stored near 0, here at the {} plane", where), kSource,
            predicts};
  }
  // In perspective the true distance is the smaller one, n f / (n + (f - n) q / 2) that reads back as f; else the
  // larger one, n + (f - n) q / 2.
  const double steps = setting.perspective ? error : error / (1.0 - error);
  return {1.0 + steps / rounding, TheoryKind::kQuantum,
          fmt::format("1 + {:.4g} / {:.3g}, half a quantum at the {} plane", steps, rounding, where), kSource,
          predicts};
}

constexpr int kSize = 64;  // of the texture
constexpr int kCount = kSize * kSize;
constexpr int kPerQuantum = 128;  // depths that are tried at a plane

/// Places a third of the depths over the range, at equal ratios of distance, and a third within some quanta of each
/// end. The near plane is one unit away.
std::vector<double> place_depths(double far, const filters::DepthCurve& curve, double quantum) {
  std::vector<double> depths;
  for (int i = 0; i < kCount; ++i) {
    const int third = kCount / 3, k = i % third;
    const double from_end = k * quantum / kPerQuantum;
    if (i < third)
      depths.push_back(from_end);
    else if (i < 2 * third)
      depths.push_back(1.0 - from_end);
    else
      depths.push_back(curve.store((std::pow(far, static_cast<double>(k % third) / third) - 1.0) / (far - 1.0)));
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

/// A distance that came back as another one.
struct DepthError {
  double relative = 0.0;  ///< of the distance
  double distance = 1.0;  ///< where, in units of the near plane's
  double depth = 0.0;     ///< of the depth that is stored there
};

/// A depth map that known distances are drawn into, as squares that face the light, and read back from. Nothing is
/// allocated before the first use, which throws Error as render::ShadowMap: where the GL lacks the format, or stores it
/// in other bits.
class StoredDepths {
 public:
  StoredDepths(render::ShaderLibrary& shaders, GLenum format) : shaders_(shaders), format_(format) {}

  /// Looks at distances between the planes, and densely at both planes, where a quantum of depth counts most.
  DepthError find_largest_error(double far, const filters::DepthCurve& curve) {
    const double quantum = format_ == GL_DEPTH_COMPONENT32F ? 0x1p-24 : filters::depth_quantum(0.0, describe(format_));
    const std::vector<double> depths = place_depths(far, curve, quantum), kept = keep(depths);
    const auto distance_of = [&](double depth) { return 1.0 + curve.linear(depth) * (far - 1.0); };
    DepthError largest;
    for (std::size_t i = 0; i < kept.size(); ++i) {
      const double distance = distance_of(depths[i]), relative = std::abs(distance_of(kept[i]) / distance - 1.0);
      if (!(relative <= largest.relative)) largest = {relative, distance, std::abs(kept[i] - depths[i])};
    }
    largest_ = std::max(largest_, largest.depth);
    return largest;
  }

  /// The largest error of a stored depth that made a distance the worst of all.
  double largest_error() const { return largest_; }

 private:
  render::ShaderLibrary& shaders_;
  GLenum format_;
  std::optional<render::ShadowMap> map_;
  double largest_ = 0.0;

  /// Stores depths and reads them back.
  std::vector<double> keep(const std::vector<double>& depths) {
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
};

Observation judge_error(const DepthError& seen) {
  const auto why = [&](double bound) {
    return fmt::format("off by {:.3g} of the distance at {:.4g} near-plane distances, over {:g}", seen.relative,
                       seen.distance, bound);
  };
  if (!std::isfinite(seen.relative))
    return {Verdict::kBroken, std::nullopt, "a distance reads back as NaN or infinite"};
  return judge_by_bounds(seen.relative, kBound, kBroken, why);
}

/// A GL whose own conversion does not round to the nearest: theory with its error in place of half a quantum.
std::string explain_by_conversion(const Disagreement& missed, const Setting& setting, double largest_error) {
  const double rounding = find_quantum(setting);
  if (!missed.measured || !missed.theory.onset || largest_error <= rounding) return {};
  const double onset = 1.0 + (*missed.theory.onset - 1.0) * rounding / largest_error;
  if (std::abs(*missed.measured / onset - 1.0) > 2.0 * kOnsetPrecision) return {};
  return fmt::format("this GL stores depths up to {:.3g} quanta off there, which is met at {:.4g}",
                     0.5 * largest_error / rounding, onset);
}

Case make_case(const AxisInputs& inputs, const Setting& setting) {
  if (!inputs.renderer) return {.variant = name(setting), .not_available = "there is no GL"};
  Case item{.variant = name(setting)};
  item.theories = {make_theory(setting, kBound, Verdict::kDegraded), make_theory(setting, kBroken, Verdict::kBroken)};
  const auto depths = std::make_shared<StoredDepths>(inputs.renderer->shaders, setting.format);
  item.explain = [setting, depths](const Disagreement& missed) {
    return explain_by_conversion(missed, setting, depths->largest_error());
  };
  item.observe = [setting, depths](double ratio) {
    return judge_error(depths->find_largest_error(ratio, {setting.reversed, setting.perspective ? ratio : 1.0}));
  };
  return item;
}

std::vector<Setting> list_settings() {
  std::vector<Setting> settings;
  for (const bool perspective : {false, true}) {
    for (const GLenum format : {GL_DEPTH_COMPONENT16, GL_DEPTH_COMPONENT24, GL_DEPTH_COMPONENT32F})
      for (const bool reversed : {false, true}) settings.push_back({format, perspective, reversed});
  }
  return settings;
}

std::vector<Case> make_cases(const AxisInputs& inputs) {
  std::vector<Case> cases;
  for (const Setting& setting : list_settings()) cases.push_back(make_case(inputs, setting));
  return cases;
}

}  // namespace depth_formats

Axis make_depth_formats_axis() {
  using namespace depth_formats;
  Axis axis;
  axis.title = "Depth formats: what is left of a distance";
  axis.quantity = "far plane's distance / near plane's";
  axis.range = {10.0, 1e7};
  axis.limits = {1.5, 1e9};
  axis.coarse_samples = 25;
  axis.measured = "largest relative error of a distance, stored and read back";
  axis.bound = kBound;
  axis.broken_when = fmt::format("a distance reads back more than {:g} of itself off, or not finite", kBroken);
  axis.make_cases = make_cases;
  return axis;
}

}  // namespace shadowbench::stress
