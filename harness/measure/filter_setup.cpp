#include "harness/measure/filter_setup.h"

namespace shadowbench::measure {

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

}  // namespace shadowbench::measure
