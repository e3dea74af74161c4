#include "harness/stress/drawn_scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "harness/measure/scene_assets.h"
#include "harness/render/bias/bias_rule.h"
#include "harness/scene/lights/light_fit.h"
#include "harness/scene/load.h"

namespace shadowbench::stress {
namespace {

constexpr float kNearOne = 1e-3f;  // all is lit, or dark: every pixel is this near to it

/// Pixels that should be equal and are not.
struct Differences {
  std::size_t darker = 0;
  std::size_t brighter = 0;
  std::size_t count() const { return darker + brighter; }
};

Differences count_differences(const std::vector<float>& seen, const std::vector<float>& expected) {
  Differences found;
  for (std::size_t i = 0; i < seen.size(); ++i) {
    const double change = static_cast<double>(seen[i]) - static_cast<double>(expected[i]);
    if (change < -kVisibleDifference) ++found.darker;
    if (change > kVisibleDifference) ++found.brighter;
  }
  return found;
}

/// Whether all surfaces are lit, or dark. The background does not count, but a picture of background alone is lit.
bool is_all(const Drawing& drawing, float of) {
  bool any = false;
  for (std::size_t i = 0; i < drawing.visibility.size(); ++i) {
    if (drawing.position[i].w == 0.0f) continue;
    any = true;
    if (std::abs(drawing.visibility[i] - of) >= kNearOne) return false;
  }
  return any || of == 1.0f;
}

std::vector<glm::vec4> read_positions(const gl::Texture& texture) {
  const std::vector<float> values = texture.read_floats(4);
  std::vector<glm::vec4> positions;
  for (std::size_t i = 0; i + 3 < values.size(); i += 4)
    positions.emplace_back(values[i], values[i + 1], values[i + 2], values[i + 3]);
  return positions;
}

}  // namespace

scene::Scene load_drawn_scene(const AxisInputs& inputs, const std::string& name, const DrawingSize& size) {
  return scene::load(
      name, {.scenes_folder = inputs.resources.scenes, .aspect = static_cast<double>(size.width) / size.height});
}

SceneDrawer::SceneDrawer(const AxisInputs& inputs, filters::FilterRequest request, const DrawingSize& size)
    : seed_(inputs.seed), size_(size), stage_(inputs, std::move(request)) {}

scene::LightFrustum SceneDrawer::fit(const scene::Scene& scene) const {
  const filters::FilterRequest& request = stage_.request();
  const double padding = measure::limit_padding(measure::largest_padding_texels({request}), size_.map);
  return scene::fit_light(scene, scene::FitMode::kTight, size_.map, padding);
}

Drawing SceneDrawer::draw(const scene::Scene& scene) {
  const filters::FilterRequest& request = stage_.request();
  const scene::LightFrustum frustum = fit(scene);
  const render::Bias bias = render::resolve_bias({}, frustum, request.spec, request.values);
  const render::Geometry geometry(scene);
  stage_.resize({size_.map, size_.width, size_.height});
  stage_.map().draw(stage_.shaders(), geometry, frustum);
  stage_.gbuffer().draw(stage_.shaders(), geometry, scene, scene.cameras.front());
  return {stage_.look_up(render::make_light_setup(frustum, scene.light, bias, seed_), request.values),
          read_positions(stage_.gbuffer().position())};
}

Observation judge_drawing(const Drawing& seen, const Drawing& expected, double bound) {
  const auto unusable = std::ranges::count_if(seen.visibility, [](float v) { return !std::isfinite(v); });
  if (unusable > 0)
    return {Verdict::kBroken, std::nullopt,
            fmt::format("{} of {} pixels are NaN or infinite", unusable, seen.visibility.size())};
  const Differences found = count_differences(seen.visibility, expected.visibility);
  const double share = static_cast<double>(found.count()) / static_cast<double>(seen.visibility.size());
  for (const auto& [of, name] : {std::pair(1.0f, "lit"), std::pair(0.0f, "dark")})
    if (is_all(seen, of) && !is_all(expected, of)) return {Verdict::kBroken, share, fmt::format("all is {}", name)};
  if (share <= bound) return {Verdict::kOk, share, {}};
  return {Verdict::kDegraded, share,
          fmt::format("{:.2g} of the pixels differ, {} darker and {} brighter", share, found.darker, found.brighter)};
}

}  // namespace shadowbench::stress
