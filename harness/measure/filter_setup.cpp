#include "harness/measure/filter_setup.h"

#include <map>

#include "filters/front_matter.h"

namespace shadowbench::measure {
namespace {

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

void draw_without_bias(Renderer& renderer, const options::RunOptions& options, SceneAssets& assets, LightMap& light,
                       render::FilterPasses& filter, const std::function<void()>& draw) {
  const filters::ParamValues values = filter.request().values;
  const render::LightLayers own = filter.light();
  render::LightLayers unbiased = own;
  for (render::LightSetup& layer : unbiased) {
    layer.bias = {};
    layer.bias.max_tangent = 0.0;  // the passes may follow the receiver's plane: let it be flat
  }
  const bool biased_map = options.bias.map != render::MapBias();
  if (biased_map) assets.redraw(light, {});
  filter.retune(renderer.shaders, values, unbiased);
  draw();
  filter.retune(renderer.shaders, values, own);
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
