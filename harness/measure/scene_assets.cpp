#include "harness/measure/scene_assets.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/error.h"
#include "harness/measure/phases.h"
#include "harness/measure/scene_truth.h"
#include "harness/render/picture_passes.h"
#include "harness/scene/lights/light_fit.h"
#include "harness/scene/scene.h"
#include "report/images/picture_io.h"

namespace shadowbench::measure {

namespace {

/// The least and the largest depth in a G-buffer.
std::optional<scene::DepthSpan> find_seen_depths(const render::GBuffer& gbuffer) {
  const std::vector<float> positions = gbuffer.position().read_floats(4);
  scene::DepthSpan span{std::numeric_limits<double>::max(), 0.0};
  for (std::size_t i = 3; i < positions.size(); i += 4) {
    if (positions[i] == 0.0f) continue;
    const double depth = static_cast<double>(positions[i]);
    span = {std::min(span.near_m, depth), std::max(span.far_m, depth)};
  }
  return span.far_m > 0.0 ? std::optional(span) : std::nullopt;
}

/// The half-width in texels of the widest kernel of these filters.
double largest_radius_texels(const std::vector<filters::FilterRequest>& requests) {
  double largest = 0.0;
  for (const auto& request : requests)
    largest = std::max(largest, filters::radius_texels(request.spec, request.values));
  return largest;
}

}  // namespace

std::vector<scene::LightFrustum> fit_map_layers(const options::RunOptions& options, const MapFit& fit,
                                                const std::function<const render::GBuffer&()>& gbuffer) {
  scene::FitRequest request{.mode = options.fit.mode,
                            .map_size = fit.map_size,
                            .pad_texels = limit_padding(fit.pad_texels, fit.map_size),
                            .snap = options.snap,
                            .camera = &fit.camera,
                            .aspect = static_cast<double>(options.width) / options.height,
                            .light = &fit.light,
                            .shift_texels = fit.shift_texels,
                            .cascades = options.fit.cascades};
  if (options.fit.mode == scene::FitMode::kCascades && options.fit.cascades.seen)
    request.seen = find_seen_depths(gbuffer());
  return scene::fit_layers(fit.scene, request);
}

SceneAssets::SceneAssets(Renderer& renderer, const options::RunOptions& options, const scene::Scene& scene,
                         truth::TruthCache& cache, double pad_texels)
    : renderer_(renderer),
      options_(options),
      scene_(scene),
      pad_texels_(pad_texels),
      geometry_(scene),
      tracer_([&scene] { return scene::list_occluders(scene); }, cache, options.seed) {}

LightMap& SceneAssets::light_map(const scene::Camera& camera, int map_size) {
  const std::pair key(options_.fit.follows_view() ? &camera : nullptr, map_size);
  const auto found = maps_.find(key);
  if (found != maps_.end()) return found->second;
  const glm::dvec2 first_shift = list_phase_shifts(options_.phases, options_.seed).front();
  LightMap& kept = maps_.emplace(key, make_light_map(scene_.light, camera, map_size, first_shift)).first->second;
  require_casters(kept);
  return kept;
}

LightMap SceneAssets::make_light_map(const scene::Light& light, const scene::Camera& camera, int map_size,
                                     const glm::dvec2& shift_texels) {
  std::vector<scene::LightFrustum> layers =
      fit_map_layers(options_, {scene_, light, camera, map_size, pad_texels_, shift_texels},
                     [&]() -> const render::GBuffer& { return gbuffer(camera); });
  return draw_map(std::move(layers), map_size);
}

std::optional<LightMap> SceneAssets::make_stepped_map(const scene::Camera& camera, int map_size) {
  if (!scene::follows_camera(scene_.light, options_.fit)) return std::nullopt;
  const LightMap& before = light_map(camera, map_size);
  scene::Camera moved = camera;
  moved.position_ws += glm::vec3(kCameraStepTexels * before.frustum().texel_size_ws * scene::ViewAxes(camera).right);
  std::optional<render::GBuffer> seen;
  std::vector<scene::LightFrustum> layers = fit_map_layers(
      options_,
      {scene_, scene_.light, moved, map_size, pad_texels_, list_phase_shifts(options_.phases, options_.seed).front()},
      [&]() -> const render::GBuffer& {
        draw_view(seen.emplace(options_.width, options_.height), moved);
        return *seen;
      });
  for (std::size_t i = 0; i < layers.size(); ++i)
    if (scene::has_same_grid(before.layers[i], layers[i])) layers[i] = before.layers[i];
  return draw_map(std::move(layers), map_size);
}

LightMap SceneAssets::draw_map(std::vector<scene::LightFrustum> layers, int map_size) {
  render::ShadowMap map(map_size, options_.map, static_cast<int>(layers.size()));
  LightMap made{std::move(layers), std::move(map)};
  made.map.set_border(options_.range.border);
  redraw(made);
  return made;
}

void SceneAssets::redraw(LightMap& light, const render::MapBias& bias) {
  for (const scene::LightFrustum& layer : light.layers) light.map.draw(renderer_.shaders, geometry_, layer, bias);
}

images::Image read_linear_depth(const render::ShadowMap& map) {
  images::Image picture = map.read_picture();
  for (float& depth : picture.texels) depth = map.settings().curve.linear(depth);
  return picture;
}

bool SceneAssets::has_casters(const LightMap& light) {
  const images::Image map = light.map.read_picture();
  return std::ranges::any_of(map.texels, [&](float d) { return d != light.map.settings().curve.far_plane(); });
}

void SceneAssets::require_casters(const LightMap& light) const {
  if (!options_.bias.map.cull_front) return;
  if (has_casters(light)) return;
  throw Error(ErrorKind::kUsage,
              fmt::format("--bias front-cull leaves nothing of the scene '{}' in its shadow map: all its "
                          "casters are open meshes; choose another bias, or set may_cull_front = false on "
                          "some objects",
                          scene_.name));
}

render::GBuffer& SceneAssets::gbuffer(const scene::Camera& camera) {
  const auto found = gbuffers_.find(&camera);
  if (found != gbuffers_.end()) return found->second;
  render::GBuffer& kept = gbuffers_.try_emplace(&camera, options_.width, options_.height).first->second;
  draw_view(kept, camera);
  return kept;
}

void SceneAssets::draw_view(render::GBuffer& gbuffer, const scene::Camera& camera, const glm::dvec2& jitter,
                            const std::optional<render::PictureWindow>& window) {
  gbuffer.draw(renderer_.shaders, geometry_, scene_, camera, jitter, window);
}

const SceneTruth& SceneAssets::truth(const scene::Camera& camera) {
  const auto found = truths_.find(&camera);
  if (found != truths_.end()) return found->second;
  return truths_.emplace(&camera, make_truth(camera)).first->second;
}

SceneTruth SceneAssets::make_truth(const scene::Camera& camera) {
  SceneTruth truth;
  if (!options_.truth) {
    truth.absent = "the run was made with --no-truth";
    if (options_.all_parts) truth.receivers = read_view_receivers(gbuffer(camera), scene_.light);
    return truth;
  }
  render::GBuffer& view = gbuffer(camera);
  truth = trace_scene(tracer_, scene_.light, read_view_receivers(view, scene_.light), options_.truth_weight);
  if (!truth.absent.empty()) return truth;
  const auto shaded = [&](const images::Image& visibility) {
    return render::shade(renderer_.shaders, view, render::upload_image(visibility), scene_, camera);
  };
  truth.hard_picture = shaded(truth.hard);
  truth.area_picture = shaded(truth.ratio);
  truth.area_seen = view_picture(images::round_to_half(truth.area_picture));
  return truth;
}

double largest_padding_texels(const std::vector<filters::FilterRequest>& requests) {
  return std::ceil(largest_radius_texels(requests)) + 1.0;
}

double limit_padding(double pad_texels, int map_size) { return std::min(pad_texels, 0.25 * (map_size - 1)); }

double padding_texels(const options::RunOptions& options) {
  return options.pad_texels.value_or(largest_padding_texels(options.filters));
}

double widest_kernel_texels(const options::RunOptions& options) {
  return options.pad_texels ? std::max(*options.pad_texels - 1.0, 0.0) : largest_radius_texels(options.filters);
}

}  // namespace shadowbench::measure
