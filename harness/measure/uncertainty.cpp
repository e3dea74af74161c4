#include "harness/measure/uncertainty.h"

#include <algorithm>
#include <cmath>

#include "filters/model.h"
#include "filters/random.h"
#include "harness/measure/filter_setup.h"
#include "harness/measure/receiver_pixels.h"
#include "harness/render/receivers.h"

namespace shadowbench::measure {
namespace {

/// Bounds what the same computation in single precision may make of each pixel.
images::Image bound_rounding(const DrawnTask& drawn, const filters::Model& model, const render::FilterPasses& filter) {
  const options::RunOptions& options = drawn.options;
  const LightMap& light = drawn.assets.light_map(*drawn.task.camera, drawn.task.map_size);
  const filters::FilterRequest& request = filter.request();
  images::Image image(options.width, options.height, 1);
  for (const render::LightSetup& layer : filter.light()) {
    const filters::DepthMap map = light.map.read(layer.frustum.layer);
    const auto tracked = model.prepare({.spec = request.spec,
                                        .values = request.values,
                                        .map = map,
                                        .accuracy = measure_accuracy(drawn.renderer),
                                        .seed = options.seed,
                                        .plane_max_tangent = options.bias.plane_max_tangent()},
                                       filters::Precision::kTracked);
    const auto receivers =
        render::read_receivers(drawn.renderer.shaders, drawn.assets.gbuffer(*drawn.task.camera), layer);
    visit_in_parallel(receivers.size(), [&](std::size_t i) {
      const filters::ModelResult result = tracked->at(receivers[i]);
      const float of_share = receivers[i].layer_share < 1.0f ? 0x1p-23f : 0.0f;
      const float bound = result.bound < 1.0 ? static_cast<float>(result.bound) + of_share : 1.0f;
      float& pixel = image.texels[find_pixel(receivers[i], options.width, options.height)];
      pixel = result.excused ? images::kMayFlip : pixel + receivers[i].layer_share * bound;
    });
  }
  return image;
}

/// Mean and deviation of a pixel over a sample of seeds.
struct SeedSpread {
  images::Image mean;
  images::Image deviation;
};

SeedSpread spread_seeds(const DrawnTask& drawn, render::FilterPasses& filter) {
  const options::RunOptions& options = drawn.options;
  LightMap& light = drawn.assets.light_map(*drawn.task.camera, drawn.task.map_size);
  render::GBuffer& gbuffer = drawn.assets.gbuffer(*drawn.task.camera);
  render::ImageTarget target("visibility of a seed", GL_R32F, options.width, options.height);
  const render::LightLayers own = filter.light();
  SeedSpread spread{images::Image(options.width, options.height, 1), images::Image(options.width, options.height, 1)};
  std::vector<double> sum(spread.mean.texels.size()), squares(sum.size());
  for (std::uint32_t i = 1; i <= static_cast<std::uint32_t>(images::kSpreadSeeds); ++i) {
    render::LightLayers other = own;
    for (render::LightSetup& layer : other) layer.seed = filters::hash_bits(own.front().seed + i);
    filter.retune(drawn.renderer.shaders, filter.request().values, other);
    const images::Image image = draw_visibility(filter, light.map, gbuffer, target);
    for (std::size_t p = 0; p < sum.size(); ++p) {
      const double value = static_cast<double>(image.texels[p]);
      sum[p] += value;
      squares[p] += value * value;
    }
  }
  filter.retune(drawn.renderer.shaders, filter.request().values, own);
  for (std::size_t p = 0; p < sum.size(); ++p) {
    const double n = images::kSpreadSeeds, mean = sum[p] / n;
    spread.mean.texels[p] = static_cast<float>(mean);
    spread.deviation.texels[p] = static_cast<float>(std::sqrt(std::max(squares[p] - n * mean * mean, 0.0) / (n - 1.0)));
  }
  return spread;
}

}  // namespace

images::UncertaintyImages measure_uncertainty(const DrawnTask& drawn, render::FilterPasses& filter) {
  images::UncertaintyImages uncertainty;
  const filters::FilterRequest& request = filter.request();
  const auto model = filters::make_model(request.spec);
  if (model) uncertainty.rounding = bound_rounding(drawn, *model, filter);
  if (request.spec.kind != filters::FilterKind::kStochastic) return uncertainty;
  SeedSpread spread = spread_seeds(drawn, filter);
  uncertainty.seed_mean = std::move(spread.mean);
  uncertainty.seed_deviation = std::move(spread.deviation);
  return uncertainty;
}

}  // namespace shadowbench::measure
