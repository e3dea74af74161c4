#include "harness/measure/uncertainty.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "filters/model.h"
#include "filters/random.h"
#include "harness/render/image_target.h"
#include "harness/render/receivers.h"

namespace shadowbench::measure {
namespace {

/// What the same computation in single precision may make of each pixel.
images::Image bound_rounding(const DrawnTask& drawn, const filters::Model& model, const render::FilterPasses& filter) {
  const options::RunOptions& options = drawn.options;
  const filters::DepthMap map = drawn.assets.light_map(*drawn.task.camera, drawn.task.map_size).map.read();
  const filters::FilterRequest& request = filter.request();
  const auto tracked = model.prepare({request.spec, request.values, map, measure_accuracy(drawn.renderer), options.seed,
                                      options.bias.plane_max_tangent()},
                                     filters::Precision::kTracked);
  const auto receivers =
      render::read_receivers(drawn.renderer.shaders, drawn.assets.gbuffer(*drawn.task.camera), filter.light());
  images::Image image(options.width, options.height, 1);
  tbb::parallel_for(
      tbb::blocked_range<std::size_t>(0, receivers.size(), 1024), [&](const tbb::blocked_range<std::size_t>& range) {
        for (std::size_t i = range.begin(); i < range.end(); ++i) {
          const filters::Receiver& r = receivers[i];
          const filters::ModelResult result = tracked->at(r);
          const float bound = result.bound < 1.0 ? static_cast<float>(result.bound) : 1.0f;
          *image.at(r.pixel.x, options.height - 1 - r.pixel.y) = result.excused ? images::kMayFlip : bound;
        }
      });
  return image;
}

/// Draws with other seeds; the deviation is that of a sample.
void spread_seeds(const DrawnTask& drawn, MeasuredCell& cell, render::FilterPasses& filter) {
  const options::RunOptions& options = drawn.options;
  LightMap& light = drawn.assets.light_map(*drawn.task.camera, drawn.task.map_size);
  render::GBuffer& gbuffer = drawn.assets.gbuffer(*drawn.task.camera);
  render::ImageTarget target("visibility of a seed", GL_R32F, options.width, options.height);
  const render::LightSetup own = filter.light();
  std::vector<double> sum(cell.visibility.texels.size()), squares(sum.size());
  for (std::uint32_t i = 1; i <= static_cast<std::uint32_t>(images::kSpreadSeeds); ++i) {
    render::LightSetup other = own;
    other.seed = filters::hash_bits(own.seed + i);
    filter.retune(drawn.renderer.shaders, filter.request().values, other);
    filter.prefilter(light.map);
    filter.lookup(gbuffer, light.map, target);
    const images::Image image = render::read_image(target.texture(), 1);
    for (std::size_t p = 0; p < sum.size(); ++p) {
      const double value = static_cast<double>(image.texels[p]);
      sum[p] += value;
      squares[p] += value * value;
    }
  }
  filter.retune(drawn.renderer.shaders, filter.request().values, own);
  cell.uncertainty.seed_mean = cell.uncertainty.seed_deviation = images::Image(options.width, options.height, 1);
  for (std::size_t p = 0; p < sum.size(); ++p) {
    const double n = images::kSpreadSeeds, mean = sum[p] / n;
    cell.uncertainty.seed_mean.texels[p] = static_cast<float>(mean);
    cell.uncertainty.seed_deviation.texels[p] =
        static_cast<float>(std::sqrt(std::max(squares[p] - n * mean * mean, 0.0) / (n - 1.0)));
  }
}

}  // namespace

void measure_uncertainty(const DrawnTask& drawn, MeasuredCell& cell, render::FilterPasses& filter) {
  const filters::FilterRequest& request = filter.request();
  const auto model = request.user_file ? nullptr : filters::make_model(request.spec.id);
  if (model) cell.uncertainty.rounding = bound_rounding(drawn, *model, filter);
  if (request.spec.kind == filters::FilterKind::kStochastic) spread_seeds(drawn, cell, filter);
}

}  // namespace shadowbench::measure
