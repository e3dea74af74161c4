#include "harness/measure/accumulation/frame_drawing.h"

namespace shadowbench::measure {
namespace {

/// The radical inverse: the digits of a number, mirrored at the point.
double find_radical_inverse(int number, int base) {
  double sum = 0.0;
  for (double digit = 1.0 / base; number > 0; number /= base, digit /= base) sum += digit * (number % base);
  return sum;
}

}  // namespace

glm::dvec2 find_jitter(int frame) {
  const int point = frame % kJitters + 1;
  return {find_radical_inverse(point, 2) - 0.5, find_radical_inverse(point, 3) - 0.5};
}

const std::vector<NamedRule>& list_resolve_rules() {
  static const std::vector<NamedRule> rules = {{"newest", {.least_weight = 1.0f, .clamps = false}},
                                               {"mean", {.least_weight = 0.0f, .clamps = false}},
                                               {"exponential", {.clamps = false}},
                                               {"clamped", {}}};
  return rules;
}

std::vector<render::ResolvePass> make_resolves(const FrameBench& bench, std::size_t first) {
  std::vector<render::ResolvePass> resolves;
  for (std::size_t i = first; i < list_resolve_rules().size(); ++i)
    resolves.emplace_back(list_resolve_rules()[i].rule, bench.options.width, bench.options.height);
  return resolves;
}

FrameDrawing::FrameDrawing(const FrameBench& bench, const filters::FilterRequest& request)
    : bench_(bench),
      filter_(make_filter_passes(bench.renderer, bench.options, *bench.task.scene,
                                 bench.assets.light_map(*bench.task.camera, bench.task.map_size), request)),
      target_("visibility", GL_R32F, bench.options.width, bench.options.height) {}

void FrameDrawing::draw(const ShownFrame& frame, std::vector<render::ResolvePass>& resolves) {
  render::LightLayers light = make_filter_light(bench_.options, frame.light, frame.map.layers, filter_->request());
  for (render::LightSetup& layer : light) layer.frame = frame.number;
  render::ShaderLibrary& shaders = bench_.renderer.shaders;
  filter_->retune(shaders, filter_->request().values, light);
  filter_->prefilter(frame.map.map);
  filter_->lookup(frame.gbuffer, frame.map.map, target_);
  for (render::ResolvePass& resolve : resolves)
    resolve.add(shaders, *bench_.task.scene, {frame.gbuffer, target_.texture(), *bench_.task.camera});
}

images::Image FrameDrawing::average(ShownFrame frame, int count) {
  std::vector<render::ResolvePass> mean;
  mean.emplace_back(render::ResolveRule{.least_weight = 0.0f, .clamps = false}, bench_.options.width,
                    bench_.options.height);
  for (int i = 0; i < count; ++i, ++frame.number) draw(frame, mean);
  return render::read_image(mean.front().texture(), 1);
}

}  // namespace shadowbench::measure
