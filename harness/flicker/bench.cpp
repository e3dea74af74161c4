#include "harness/flicker/bench.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/error.h"

namespace shadowbench::flicker {
namespace {

double choose_padding(const options::RunOptions& options) {
  return measure::limit_padding(measure::largest_padding_texels(options.filters), options.map_sizes.front());
}

double sum_squares(const std::vector<float>& errors, const std::vector<std::uint8_t>& mask) {
  double sum = 0.0;
  for (std::size_t i = 0; i < mask.size(); ++i)
    sum += mask[i] ? static_cast<double>(errors[i]) * static_cast<double>(errors[i]) : 0.0;
  return sum;
}

}  // namespace

FlickerBench::FlickerBench(measure::Renderer& renderer, const options::RunOptions& options, const scene::Scene& scene,
                           truth::TruthCache& cache)
    : renderer_(renderer),
      options_(options),
      scene_(scene),
      assets_(renderer, options, scene, cache, choose_padding(options)),
      map_(assets_.make_light_map(scene.light, scene.cameras.front(), options.map_sizes.front())),
      target_("visibility", GL_R32F, options.width, options.height),
      receivers_(measure::read_view_receivers(assets_.gbuffer(camera()), scene.light)) {
  measure::require_one_layer(map_, "flicker", scene.name);
  if (!receivers_.any_counts())
    throw Error(ErrorKind::kInput,
                fmt::format("{}: no surface in view faces the light; choose another scene", scene.name));
  for (const filters::FilterRequest& request : options.filters)
    filters_.push_back(measure::make_filter_passes(renderer, options, scene, map_, request));
}

MapFollowing FlickerBench::following(bool snap) const {
  return {options_.map_sizes.front(), choose_padding(options_), static_cast<double>(options_.width) / options_.height,
          snap};
}

TruthFrames FlickerBench::trace(Motion motion, const std::vector<Frame>& frames, const std::vector<std::uint8_t>& mask,
                                const std::function<void(int)>& on_frame) {
  TruthFrames truth;
  if (motion == Motion::kCamera) {
    truth.visibility.assign(frames.size(), std::vector<float>(mask.size()));
    truth.traced = false;
    return truth;
  }
  double squares = 0.0, before = 0.0;
  for (std::size_t t = 0; t < frames.size(); ++t) {
    on_frame(static_cast<int>(t));
    const scene::Light& light = frames[t].light;
    const auto receivers = measure::read_view_receivers(assets_.gbuffer(camera()), light);
    const auto rays = assets_.tracer().trace_view(receivers.image, scene::make_area_light(light));
    const double errors = sum_squares(rays.area.standard_error, mask);
    if (t > 0) squares += before + errors;
    before = errors;
    truth.visibility.push_back(rays.area.visibility);
  }
  const auto count = static_cast<double>(std::ranges::count(mask, std::uint8_t{1}));
  truth.noise = std::sqrt(squares / (count * static_cast<double>(frames.size() - 1)));
  return truth;
}

images::Image FlickerBench::draw(render::FilterPasses& filter) {
  filter.retune(renderer_.shaders, filter.request().values,
                measure::make_filter_light(options_, scene_.light, map_.layers, filter.request()));
  return measure::draw_visibility(filter, map_.map, assets_.gbuffer(camera()), target_);
}

std::vector<metrics::FlickerStats> FlickerBench::measure(const std::vector<scene::LightFrustum>& frusta,
                                                         const std::vector<std::uint8_t>& mask,
                                                         const TruthFrames& truth,
                                                         const std::function<void(int)>& on_frame) {
  std::vector<metrics::FlickerMeter> meters(filters_.size(), metrics::FlickerMeter(mask));
  for (std::size_t t = 0; t < frusta.size(); ++t) {
    on_frame(static_cast<int>(t));
    map_.layers = {frusta[t]};
    assets_.redraw(map_);
    for (std::size_t i = 0; i < filters_.size(); ++i) meters[i].add(draw(*filters_[i]).texels, truth.visibility[t]);
  }
  renderer_.context->require_no_gl_errors();
  std::vector<metrics::FlickerStats> stats;
  for (const metrics::FlickerMeter& meter : meters) stats.push_back(meter.finish().value());
  return stats;
}

}  // namespace shadowbench::flicker
