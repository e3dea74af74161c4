#pragma once

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "filters/scalar.h"
#include "harness/gl/context/context.h"
#include "harness/gl/recorder.h"
#include "harness/gl/survey.h"
#include "harness/measure/scene_truth.h"
#include "harness/options/options.h"
#include "harness/render/filter_passes.h"
#include "harness/render/gbuffer.h"
#include "harness/render/geometry.h"
#include "harness/render/shader_library.h"
#include "harness/render/shadow_map.h"

namespace shadowbench::measure {

/// The GL context of a run with what was found out about it.
struct Renderer {
  std::unique_ptr<gl::Context> context;
  std::vector<std::string> refused;  ///< contexts that `auto` could not use, and why
  gl::TimerKind timer = gl::TimerKind::kWallClock;
  render::ShaderLibrary shaders;
  std::optional<filters::GlAccuracy> accuracy = std::nullopt;  ///< see measure_accuracy()
  std::unique_ptr<gl::Recorder> recorder = nullptr;            ///< only where what is drawn is written down
};

/// Makes a context and chooses its timer by measurement.
/// Throws Error(kContext).
Renderer make_renderer(gl::Backend backend, const options::Resources& resources);

/// How exact the GL's functions and filtering weights are, by experiment: what propagated rounding bounds start
/// from. Cost: under 2 s when first asked for, nothing then.
filters::GlAccuracy measure_accuracy(Renderer& renderer);

/// A light's depth map with the frusta that its layers were drawn in.
struct LightMap {
  std::vector<scene::LightFrustum> layers;  ///< one, or those that share the receivers
  render::ShadowMap map;

  const scene::LightFrustum& frustum() const { return layers.front(); }
};

/// What a light's map is fitted to.
struct MapFit {
  const scene::Scene& scene;
  const scene::Light& light;
  const scene::Camera& camera;
  int map_size = 1024;
  double pad_texels = 0.0;  ///< left around the scene, limit_padding() applied
  glm::dvec2 shift_texels{0.0};
};

/// Fits the layers of a light's map as a run does. `gbuffer` is asked for where the depths that it shows decide.
std::vector<scene::LightFrustum> fit_map_layers(const options::RunOptions& options, const MapFit& fit,
                                                const std::function<const render::GBuffer&()>& gbuffer);

/// A step of the camera, after which a grid that follows it lies about as far from where it was as two phases do.
inline constexpr double kCameraStepTexels = 0.5;

/// What all cells of one scene share: its geometry, one G-buffer per view, one depth map per size. Each is drawn when
/// it is first asked for and kept, since neither light nor casters change during a run.
class SceneAssets {
 public:
  /// `pad_texels` is the half-width of the run's widest kernel: every filter sees the same map.
  SceneAssets(Renderer& renderer, const options::RunOptions& options, const scene::Scene& scene,
              truth::TruthCache& cache, double pad_texels);

  /// The light's map in the first of the run's phases; one for all cameras, unless the light is fitted to what each
  /// sees.
  /// Throws Error(kUsage) when the GL cannot give a map of this size.
  LightMap& light_map(const scene::Camera& camera, int map_size);

  /// Draws the map of another light than the scene's, or a map moved by parts of a texel; it is not kept.
  /// Throws Error(kUsage) when the GL cannot give a map of this size.
  LightMap make_light_map(const scene::Light& light, const scene::Camera& camera, int map_size,
                          const glm::dvec2& shift_texels = glm::dvec2(0.0));

  /// The light's map, in the first of the run's phases, after the camera has moved to its right by kCameraStepTexels of
  /// the map's first layer. A layer whose grid moved by whole texels stays where it was. Nothing where the map does not
  /// follow the camera. Throws as light_map().
  std::optional<LightMap> make_stepped_map(const scene::Camera& camera, int map_size);

  render::GBuffer& gbuffer(const scene::Camera& camera);

  /// Draws a view's receivers into a G-buffer of any size; `jitter` moves the picture, in pixels. With a window those
  /// of that part of the picture.
  void draw_view(render::GBuffer& gbuffer, const scene::Camera& camera, const glm::dvec2& jitter = glm::dvec2(0.0),
                 const std::optional<render::PictureWindow>& window = std::nullopt);

  /// The truth of a view, traced when it is first asked for.
  const SceneTruth& truth(const scene::Camera& camera);

  /// What traces this scene.
  truth::CachedTracer& tracer() { return tracer_; }

  /// Draws a map again, as a moving light would; for timing.
  void redraw(LightMap& light) { redraw(light, options_.bias.map); }

  /// Draws a map again with another bias in it.
  void redraw(LightMap& light, const render::MapBias& bias);

  /// Whether anything stands in a map. Reads it back.
  static bool has_casters(const LightMap& light);

 private:
  Renderer& renderer_;
  const options::RunOptions& options_;
  const scene::Scene& scene_;
  double pad_texels_;
  render::Geometry geometry_;
  truth::CachedTracer tracer_;
  std::map<std::pair<const scene::Camera*, int>, LightMap> maps_;  ///< the camera is null where all share a map
  std::map<const scene::Camera*, render::GBuffer> gbuffers_;
  std::map<const scene::Camera*, SceneTruth> truths_;

  LightMap draw_map(std::vector<scene::LightFrustum> layers, int map_size);
  /// Throws Error(kUsage) where culling left the map empty.
  void require_casters(const LightMap& light) const;
  SceneTruth make_truth(const scene::Camera& camera);
};

/// Reads a map back as a picture of linear depth, rows top to bottom.
images::Image read_linear_depth(const render::ShadowMap& map);

/// The padding that the widest kernel of these filters needs, in whole texels.
double largest_padding_texels(const std::vector<filters::FilterRequest>& requests);

/// Limits padding so that a map that is smaller than it keeps half of its texels for the scene.
double limit_padding(double pad_texels, int map_size);

/// Give a run's padding, and the half-width of the widest kernel that it makes room for: those that the options state,
/// or else those of the run's own filters.
double padding_texels(const options::RunOptions& options);
double widest_kernel_texels(const options::RunOptions& options);

/// A light as one filter sees it: with the run's bias, resolved for the filter's kernel in each layer of its map.
render::LightLayers make_filter_light(const options::RunOptions& options, const scene::Light& light,
                                      const std::vector<scene::LightFrustum>& layers,
                                      const filters::FilterRequest& request);

/// The layers of a light's map without bias: where receivers lie in it, whatever the filter.
render::LightLayers make_unbiased_light(const options::RunOptions& options, const scene::Light& light,
                                        const std::vector<scene::LightFrustum>& layers);

/// Compiles one filter over a light's map.
/// Throws as render::FilterPasses.
std::unique_ptr<render::FilterPasses> make_filter_passes(Renderer& renderer, const options::RunOptions& options,
                                                         const scene::Scene& scene, const LightMap& light,
                                                         const filters::FilterRequest& request);

/// Runs a filter's prefilter and lookup, and reads the visibility; `target` is of the G-buffer's size.
images::Image draw_visibility(render::FilterPasses& filter, const render::ShadowMap& map,
                              const render::GBuffer& gbuffer, render::ImageTarget& target);

/// Calls `draw` with a filter that has no bias, in its receivers and in the map; both are as before afterwards.
void draw_without_bias(const options::RunOptions& options, SceneAssets& assets, LightMap& light,
                       render::FilterPasses& filter, const std::function<void()>& draw);

/// Lookups that read what filters read of their receivers, and nothing of the map: what a lookup takes longer than its
/// empty one is the filter's own time.
struct EmptyLookups {
  std::vector<std::unique_ptr<render::FilterPasses>> passes;  ///< no two read the same
  std::vector<std::size_t> of_filter;                         ///< index into `passes`, one per filter
};

/// Compiles those that these filters need, over the light's map.
EmptyLookups make_empty_lookups(Renderer& renderer, const options::RunOptions& options, const scene::Scene& scene,
                                const LightMap& light, const std::vector<render::FilterPasses*>& filters);

}  // namespace shadowbench::measure
