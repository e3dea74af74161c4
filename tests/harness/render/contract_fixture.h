#pragma once

#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>

#include "filters/front_matter.h"
#include "filters/model.h"
#include "harness/render/image_target.h"
#include "tests/harness/render/bench_fixture.h"

namespace shadowbench::test {

/// Gives the catalogue with users' files in it: what every filter must do, a user's file must do as well.
inline const filters::Catalogue& all_filters() {
  static const filters::Catalogue all = [] {
    filters::Catalogue catalogue(options::find_resources().filters);
    const std::filesystem::path folder = std::filesystem::path(SHADOWBENCH_SOURCE_DIR) / "tests" / "user_filters";
    for (const char* file : {"nine_compares.glsl", "stored_plane.glsl"}) catalogue.add_user_file(folder / file);
    return catalogue;
  }();
  return all;
}

/// Gives the ids of all filters that keep one of these contracts; of all filters for none.
inline std::vector<std::string> ids_of(const std::vector<filters::FilterKind>& kinds = {}) {
  std::vector<std::string> ids;
  for (const filters::FilterSpec& spec : all_filters().filters())
    if (kinds.empty() || std::ranges::find(kinds, spec.kind) != kinds.end()) ids.push_back(spec.id);
  return ids;
}

/// Gives a filter with its parameters as the command line takes them, "vsm:radius=9".
inline filters::FilterRequest request_of(const std::string& text) { return all_filters().parse_requests(text).front(); }

inline bool is_stochastic(const filters::FilterRequest& request) {
  return request.spec.kind == filters::FilterKind::kStochastic;
}

/// Draws visibility once per seed 1, 2, ..., `seeds`, each as Bench::draw gives it.
inline std::vector<std::vector<float>> draw_seeds(Bench& bench, const filters::FilterRequest& request,
                                                  std::uint32_t seeds) {
  render::LightLayers light = bench.light(request);
  render::FilterPasses passes(bench.shaders(), request, bench.map(), light);
  render::ImageTarget target("visibility, by seed", GL_R32F, bench.gbuffer().width(), bench.gbuffer().height());
  std::vector<std::vector<float>> images;
  for (std::uint32_t seed = 1; seed <= seeds; ++seed) {
    for (render::LightSetup& layer : light) layer.seed = seed;
    passes.retune(bench.shaders(), request.values, light);
    passes.prefilter(bench.map());
    passes.lookup(bench.gbuffer(), bench.map(), target);
    images.push_back(target.texture().read_floats(1));
  }
  return images;
}

inline std::string name_of(const ::testing::TestParamInfo<std::string>& each) { return each.param; }

/// Gives what a hardware 2x2 comparison may be off by: the step of its weights, as measured on this GL.
inline double measured_weight_step() {
  static const int bits = gl::measure_pcf_weights(shared_context(), GL_DEPTH_COMPONENT32F).bits;
  return bits >= 22 ? 1e-4 : 1.0 / 128.0;
}

}  // namespace shadowbench::test
