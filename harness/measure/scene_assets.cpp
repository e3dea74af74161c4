#include "harness/measure/scene_assets.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/error.h"
#include "filters/front_matter.h"
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

/// A filter whose visibility is made of all that is read, so that the compiler drops none of it.
filters::FilterRequest make_empty_filter(const render::ReceiverReads& reads) {
  std::string sum = reads.place ? "r.uv.x + r.uv.y + r.depth" : "0.5";
  if (reads.plane) sum += " + r.depth_per_texel.x + r.depth_per_texel.y + r.n_dot_l + r.view_depth";
  if (reads.position) sum += " + r.position_ws.x + r.position_ws.y + r.position_ws.z";
  if (reads.normal) sum += " + r.normal_ws.x + r.normal_ws.y + r.normal_ws.z";
  filters::FilterRequest request;
  request.spec = filters::parse_filter(
      "/*+++\ntitle = \"Empty lookup\"\nsource = \"none\"\nkind = \"other\"\n+++*/\n"
      "float visibility(Receiver r) { return clamp(" +
          sum + ", 0.0, 1.0); }\n",
      "empty.glsl");
  return request;
}

}  // namespace

Renderer make_renderer(gl::Backend backend, const options::Resources& resources) {
  gl::ContextChoice choice = gl::create_context(backend);
  const gl::TimerKind timer = gl::choose_timer(*choice.context);
  return {std::move(choice.context), std::move(choice.refused), timer, render::ShaderLibrary(resources.shaders)};
}

filters::GlAccuracy measure_accuracy(Renderer& renderer) {
  if (!renderer.accuracy) renderer.accuracy = gl::survey_gl();
  return *renderer.accuracy;
}

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
  const auto [kept, is_new] = gbuffers_.try_emplace(&camera, options_.width, options_.height);
  if (is_new) draw_view(kept->second, camera);
  return kept->second;
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

render::LightLayers make_filter_light(const options::RunOptions& options, const scene::Light& light,
                                      const std::vector<scene::LightFrustum>& layers,
                                      const filters::FilterRequest& request) {
  render::LightLayers setups;
  for (const scene::LightFrustum& layer : layers) {
    const render::Bias bias = render::resolve_bias(options.bias, layer, request.spec, request.values);
    setups.push_back(render::make_light_setup(layer, light, bias, options.seed, options.range));
  }
  return setups;
}

render::LightLayers make_unbiased_light(const options::RunOptions& options, const scene::Light& light,
                                        const std::vector<scene::LightFrustum>& layers) {
  render::LightLayers setups;
  for (const scene::LightFrustum& layer : layers)
    setups.push_back(render::make_light_setup(layer, light, {}, options.seed, options.range));
  return setups;
}

std::unique_ptr<render::FilterPasses> make_filter_passes(Renderer& renderer, const options::RunOptions& options,
                                                         const scene::Scene& scene, const LightMap& light,
                                                         const filters::FilterRequest& request) {
  return std::make_unique<render::FilterPasses>(renderer.shaders, request, light.map,
                                                make_filter_light(options, scene.light, light.layers, request));
}

images::Image draw_visibility(render::FilterPasses& filter, const render::ShadowMap& map,
                              const render::GBuffer& gbuffer, render::ImageTarget& target) {
  filter.prefilter(map);
  filter.lookup(gbuffer, map, target);
  return render::read_image(target.texture(), 1);
}

void draw_without_bias(const options::RunOptions& options, SceneAssets& assets, LightMap& light,
                       render::FilterPasses& filter, const std::function<void()>& draw) {
  const render::LightLayers own = filter.light();
  render::LightLayers unbiased = own;
  for (render::LightSetup& layer : unbiased) {
    layer.bias = {};
    layer.bias.max_tangent = 0.0;  // the passes may follow the receiver's plane: let it be flat
  }
  const bool biased_map = options.bias.map != render::MapBias();
  if (biased_map) assets.redraw(light, {});
  filter.retune(unbiased);
  draw();
  filter.retune(own);
  if (biased_map) assets.redraw(light);
}

EmptyLookups make_empty_lookups(Renderer& renderer, const options::RunOptions& options, const scene::Scene& scene,
                                const LightMap& light, const std::vector<render::FilterPasses*>& filters) {
  EmptyLookups lookups;
  std::map<render::ReceiverReads, std::size_t> places;
  for (const render::FilterPasses* filter : filters) {
    const auto [place, is_new] = places.try_emplace(filter->receiver_reads(), lookups.passes.size());
    if (is_new)
      lookups.passes.push_back(make_filter_passes(renderer, options, scene, light, make_empty_filter(place->first)));
    lookups.of_filter.push_back(place->second);
  }
  return lookups;
}

}  // namespace shadowbench::measure
