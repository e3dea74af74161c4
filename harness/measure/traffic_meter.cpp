#include "harness/measure/traffic_meter.h"

#include <algorithm>
#include <cmath>

#include "harness/gl/objects.h"
#include "harness/measure/filter_setup.h"
#include "report/records/gpu_frame.h"

namespace shadowbench::measure {
namespace {

constexpr int kFrameRows = records::kGpuFrameHeight;
constexpr double kMostTexels = 1.5;  ///< of the map, under a pixel of half the rows: more, and lines are missed

/// Every how many rows and columns of the frame are asked.
int choose_step(const options::RunOptions& options, std::optional<double> texels_per_pixel) {
  const double rows = static_cast<double>(options.height) / (kFrameRows / 2);
  return texels_per_pixel && *texels_per_pixel * rows * rows <= kMostTexels ? 2 : 1;
}

int count_columns(const options::RunOptions& options, int rows) {
  return static_cast<int>(std::lround(static_cast<double>(rows) * options.width / options.height));
}

}  // namespace

TrafficMeter::TrafficMeter(Renderer& renderer, const options::RunOptions& options, const SceneTask& task,
                           SceneAssets& assets, std::optional<double> texels_per_pixel)
    : renderer_(renderer),
      options_(options),
      task_(task),
      light_(assets.light_map(*task.camera, task.map_size)),
      step_(choose_step(options, texels_per_pixel)),
      gbuffer_(count_columns(options, kFrameRows / step_), kFrameRows / step_) {
  assets.draw_view(gbuffer_, *task.camera);
  for (const gpu::Gpu& gpu : options_.gpus)
    caches_.push_back({.bytes = static_cast<std::int64_t>(gpu.cache_mib.value * 1024.0 * 1024.0),
                       .line_bytes = static_cast<int>(gpu.line_bytes.value)});
  for (const scene::LightFrustum& layer : light_.layers) layers_.push_back({light_.map.read(layer.layer), {}});
}

void TrafficMeter::measure(MeasuredCell& cell) {
  if (cell.passes.empty()) return;
  for (std::size_t i = 0; i < layers_.size(); ++i) {
    const scene::LightFrustum& layer = light_.layers[i];
    const render::Bias bias = render::resolve_bias(options_.bias, layer, cell.request.spec, cell.request.values);
    layers_[i].receivers = render::read_receivers(
        renderer_.shaders, gbuffer_,
        render::make_light_setup(layer, task_.scene->light, bias, options_.seed, options_.range));
  }
  const ModelView view{gbuffer_.width(), gbuffer_.height(), options_.seed, options_.bias.plane_max_tangent()};
  auto bytes = filters::make_model(cell.request.spec) ? count_map_traffic(cell.request, layers_, view, caches_)
               : cell.cost.fetches                    ? count_map_traffic(count_reads(cell), view, caches_)
                                                      : std::nullopt;
  if (!bytes) return;
  for (double& each : *bytes) each /= step_ * step_;
  cell.fetched_bytes = std::move(*bytes);
}

std::vector<CountedLayer> TrafficMeter::count_reads(const MeasuredCell& cell) {
  const gl::Recorder::Pause pause(renderer_.recorder.get());
  const auto passes = make_filter_passes(renderer_, options_, *task_.scene, light_, cell.request);
  passes->prefilter(light_.map);
  std::vector<CountedLayer> layers;
  for (const render::CountedReads& counted : passes->count_reads(renderer_.shaders, gbuffer_, light_.map)) {
    const ModelLayer& own = layers_[layers.size()];
    CountedLayer& layer = layers.emplace_back(CountedLayer{own.map, own.receivers, {}});
    if (passes->encoded_format()) layer.map.texel_bytes = gl::pixel_format(*passes->encoded_format()).bytes_per_texel;
    for (std::size_t i = 0; i < counted.reads.size() / 4; ++i) {
      const int of_64 = static_cast<int>(counted.wide[2 * i]), of_128 = static_cast<int>(counted.wide[2 * i + 1]);
      const int all = std::max(static_cast<int>(counted.reads[4 * i]), 0);
      layer.pixels.push_back({{all - of_64 - of_128, of_64, of_128},
                              static_cast<double>(counted.reads[4 * i + 1]) - passes->blurred_reach()});
    }
  }
  return layers;
}

}  // namespace shadowbench::measure
