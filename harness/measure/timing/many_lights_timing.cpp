#include "harness/measure/timing/many_lights_timing.h"

#include <map>

#include "harness/measure/filter_setup.h"
#include "harness/measure/timing/statistics.h"
#include "harness/scene/lights/light.h"

namespace shadowbench::measure {
namespace {

records::LightCountRecord make_record(int count, const RoundTimes& times, std::size_t filter, const LightFrame& frame) {
  const FilterTimes &own = times.filters[filter], &reference = times.filters[frame.reference];
  const std::vector<double> moving = add_moving(times.map, own);
  records::LightCountRecord record;
  record.count = count;
  record.static_ms = summarise(own.lookup);
  record.moving_ms = summarise(moving);
  record.static_ratio = find_ratio(own.lookup, reference.lookup);
  record.moving_ratio = find_ratio(moving, add_moving(times.map, reference));
  return record;
}

}  // namespace

LightFrameBench::LightFrameBench(Renderer& renderer, const options::RunOptions& options, SceneAssets& assets,
                                 const LightFrame& frame, int count)
    : renderer_(renderer), options_(options), assets_(assets), frame_(frame), gbuffer_(assets.gbuffer(*frame.camera)) {
  const std::vector<scene::Light> lights = scene::make_light_ring(*frame.light, count);
  for (const scene::Light& light : lights) maps_.push_back(assets.make_light_map(light, *frame.camera, frame.map_size));
  for (int i = 0; i < count; ++i)
    targets_.push_back(
        std::make_unique<render::ImageTarget>("visibility of a light", GL_R32F, options.width, options.height));
  prepare_filters(lights);
}

void LightFrameBench::prepare_filters(const std::vector<scene::Light>& lights) {
  std::map<GLenum, std::vector<render::EncodedTargets>>
      encoded;  // of every light, for each format that some filter stores
  for (render::FilterPasses* filter : frame_.filters) {
    std::vector<render::EncodedTargets> maps(lights.size());
    if (const auto format = filter->encoded_format()) {
      std::vector<render::EncodedTargets>& kept = encoded[*format];
      while (kept.size() < lights.size()) kept.push_back(filter->make_encoded_targets());
      maps = kept;
    }
    std::vector<render::PreparedLight>& prepared = prepared_.emplace_back();
    for (std::size_t i = 0; i < lights.size(); ++i)
      prepared.push_back(
          filter->prepare(make_filter_light(options_, lights[i], maps_[i].layers, filter->request()), maps[i]));
  }
}

void LightFrameBench::prefilter(std::size_t filter) {
  for (std::size_t i = 0; i < maps_.size(); ++i) {
    frame_.filters[filter]->turn_to(prepared_[filter][i]);
    frame_.filters[filter]->prefilter(maps_[i].map);
  }
}

void LightFrameBench::look_up(std::size_t filter) {
  for (std::size_t i = 0; i < maps_.size(); ++i) {
    frame_.filters[filter]->turn_to(prepared_[filter][i]);
    frame_.filters[filter]->lookup(gbuffer_, maps_[i].map, *targets_[i]);
  }
}

RoundTimes LightFrameBench::time() {
  const gl::TimerKind timer = renderer_.timer;
  TimedPasses timed{.draw_map = [&] {
    return gl::time_ms(timer, [&] {
      for (LightMap& map : maps_) assets_.redraw(map);
    });
  }};
  for (std::size_t i = 0; i < frame_.filters.size(); ++i) {
    std::function<void()> prefilters;
    if (frame_.filters[i]->has_prefilter()) prefilters = [this, i] { prefilter(i); };
    timed.filters.push_back(make_timed(timer, prefilters, [this, i] { look_up(i); }));
  }
  return run_rounds(timed, {.reference = frame_.reference, .limits = options_.rounds, .seed = options_.seed});
}

std::vector<std::vector<float>> LightFrameBench::draw(std::size_t filter) {
  prefilter(filter);
  look_up(filter);
  std::vector<std::vector<float>> pictures;
  for (const auto& target : targets_) pictures.push_back(target->texture().read_floats(1));
  return pictures;
}

LightMeasurement measure_lights(Renderer& renderer, const options::RunOptions& options, SceneAssets& assets,
                                const LightFrame& frame) {
  LightMeasurement result{std::vector<std::vector<records::LightCountRecord>>(frame.filters.size()), 0.0};
  for (const int count : options.lights) {
    const RoundTimes times = LightFrameBench(renderer, options, assets, frame, count).time();
    result.spent_ms += times.spent_ms;
    for (std::size_t i = 0; i < frame.filters.size(); ++i)
      result.filters[i].push_back(make_record(count, times, i, frame));
  }
  return result;
}

}  // namespace shadowbench::measure
