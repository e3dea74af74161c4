// A lamp so far away that its rays are parallel is a sun.

#include "harness/measure/view_receivers.h"
#include "harness/scene/scene.h"
#include "tests/harness/render/bench_fixture.h"

namespace shadowbench::test {
namespace {

scene::Light move_away(const scene::Light& sun, double distance_m) {
  scene::Light lamp = sun;
  const glm::vec3 target(0.0f, 0.5f, 0.0f);
  const double radius = 0.5 * scene::light_size(sun) * distance_m;
  lamp.kind = scene::Spot{target + static_cast<float>(distance_m) * scene::to_light(sun, {}), target, 3.0f, 3.0f,
                          static_cast<float>(radius)};
  return lamp;
}

/// The root mean square of what two images differ by.
double rms_of(const std::vector<float>& a, const std::vector<float>& b) {
  double sum = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i)
    sum += std::pow(static_cast<double>(a[i]) - static_cast<double>(b[i]), 2.0);
  return std::sqrt(sum / static_cast<double>(a.size()));
}

TEST(FarLamp, HasTheSunsTruth) {
  const scene::Scene scene = load_builtin("stack");
  Bench bench(shared_context(), scene, 64, 160, 90);
  const scene::Light lamp = move_away(scene.light, 2000.0), near_lamp = move_away(scene.light, 10.0);
  const truth::Occluders occluders(scene::list_occluders(scene));
  const auto trace = [&](const scene::Light& light) {
    const auto receivers = measure::read_view_receivers(bench.gbuffer(), light);
    return truth::trace_area(occluders, receivers.image, scene::make_area_light(light), {}).visibility;
  };
  const std::vector<float> sun = trace(scene.light);
  EXPECT_LT(rms_of(trace(lamp), sun), 0.01);
  EXPECT_GT(rms_of(trace(near_lamp), sun), 0.1);
}

}  // namespace
}  // namespace shadowbench::test
