#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "harness/measure/renderer.h"
#include "harness/measure/scene_assets.h"
#include "harness/render/filter_passes.h"
#include "harness/render/geometry.h"

namespace shadowbench::measure {

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
void draw_without_bias(Renderer& renderer, const options::RunOptions& options, SceneAssets& assets, LightMap& light,
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
