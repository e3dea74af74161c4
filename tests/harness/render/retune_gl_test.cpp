// Filter passes that take other parameters draw what new passes draw.

#include "tests/harness/render/bench_fixture.h"

namespace shadowbench::test {
namespace {

/// Reads what passes draw over a bench.
std::vector<float> draw(Bench& bench, render::FilterPasses& passes) {
  render::ImageTarget target("visibility", GL_R32F, bench.gbuffer().width(), bench.gbuffer().height());
  passes.prefilter(bench.map());
  passes.lookup(bench.gbuffer(), bench.map(), target);
  return target.texture().read_floats(1);
}

/// Every number of the filter at a step through its range, 0 .. 1; the others stay.
filters::FilterRequest at(filters::FilterRequest request, double step) {
  for (const filters::ParamSpec& param : request.spec.params) {
    if (param.is_const || !param.choices.empty() || !param.min) continue;
    const double value = *param.min + step * std::min(*param.max - *param.min, 24.0);
    request.values[param.name] = param.integer ? std::floor(value) : value;
  }
  return request;
}

class Retune : public ::testing::TestWithParam<const char*> {};

TEST_P(Retune, DrawsTheSameBitsAsNewPasses_ForEveryFilterAndLight) {
  const scene::Scene scene = load_builtin(GetParam());
  scene::Scene other = scene;
  other.light = scene::turn_light(
      other.light, [](const glm::vec3& way) { return glm::normalize(way + glm::vec3(0.3f, 0.0f, 0.0f)); });
  Bench bench(shared_context(), scene, 128, 96, 54), turned(shared_context(), other, 128, 96, 54);
  for (const filters::FilterRequest& request : catalogue().parse_requests("all,teaching")) {
    SCOPED_TRACE(request.spec.id);
    render::FilterPasses passes(bench.shaders(), at(request, 0.0), bench.map(), bench.light(at(request, 0.0)));
    draw(bench, passes);
    for (Bench* each : {&bench, &turned}) {
      for (const double step : {0.5, 0.0, 1.0}) {  // a radius of 0, without a blur, in between
        const filters::FilterRequest changed = at(request, step);
        passes.retune(each->shaders(), changed.values, each->light(changed));
        EXPECT_EQ(draw(*each, passes), each->draw(changed)) << step;
      }
    }
  }
}

// On "edge" the map's edge cuts casters: what lies outside it is seen. The map of a lamp that was moved curves depth
// otherwise.
INSTANTIATE_TEST_SUITE_P(Scenes, Retune, ::testing::Values("fence", "edge", "lamp", "lantern"));

}  // namespace
}  // namespace shadowbench::test
