#include "harness/stress/filter_bench.h"

#include "harness/measure/map_limits.h"

namespace shadowbench::stress {

FilterBench::FilterBench(const AxisInputs& inputs, filters::FilterRequest request)
    : shaders_(inputs.renderer->shaders), request_(std::move(request)) {}

void FilterBench::resize(const BenchSize& size) {
  if (surfaces_ && size == size_) return;
  if (size.map != size_.map) passes_.reset();
  surfaces_.emplace(size);
  size_ = size;
}

void FilterBench::upload_receivers(const std::vector<glm::vec3>& positions_ws, const glm::vec3& normal_ws) {
  std::vector<float> positions, normals;
  for (const glm::vec3& p : positions_ws) {
    positions.insert(positions.end(), {p.x, p.y, p.z, 1.0f});  // a view depth of 1 marks a surface
    normals.insert(normals.end(), {normal_ws.x, normal_ws.y, normal_ws.z, 0.0f});
  }
  surfaces_->gbuffer.upload(positions, normals);
}

std::vector<float> FilterBench::look_up(const render::LightSetup& light, const filters::ParamValues& values) {
  request_.values = values;
  if (passes_)
    passes_->retune(shaders_, values, light);
  else
    passes_.emplace(shaders_, request_, surfaces_->map, light);
  passes_->prefilter(surfaces_->map);
  passes_->lookup(surfaces_->gbuffer, surfaces_->map, surfaces_->target);
  return surfaces_->target.texture().read_floats(1);
}

std::int64_t FilterBench::count_broken_texels() { return measure::count_broken_texels(*passes_, surfaces_->map); }

scene::LightFrustum make_axis_frustum(double width_ws, int map_texels) {
  scene::LightFrustum frustum;
  frustum.width_ws = width_ws;
  frustum.texel_size_ws = width_ws / map_texels;
  frustum.depth_range_ws = 1.0;
  return frustum;
}

}  // namespace shadowbench::stress
