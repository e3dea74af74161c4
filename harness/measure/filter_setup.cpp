#include "harness/measure/filter_setup.h"

namespace shadowbench::measure {

render::LightSetup make_filter_light(const options::RunOptions& options, const scene::Light& light,
                                     const scene::LightFrustum& frustum, const filters::FilterRequest& request) {
  const render::Bias bias = render::resolve_bias(options.bias, frustum, request.spec, request.values);
  return render::make_light_setup(frustum, light, bias, options.seed, options.range);
}

std::unique_ptr<render::FilterPasses> make_filter_passes(Renderer& renderer, const options::RunOptions& options,
                                                         const scene::Scene& scene, const LightMap& light,
                                                         const filters::FilterRequest& request) {
  return std::make_unique<render::FilterPasses>(renderer.shaders, request, light.map,
                                                make_filter_light(options, scene.light, light.frustum, request));
}

images::Image draw_visibility(render::FilterPasses& filter, const render::ShadowMap& map,
                              const render::GBuffer& gbuffer, render::ImageTarget& target) {
  filter.prefilter(map);
  filter.lookup(gbuffer, map, target);
  return render::read_image(target.texture(), 1);
}

}  // namespace shadowbench::measure
