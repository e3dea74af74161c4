// What a run calls flicker.

#include <gmock/gmock.h>

#include "harness/measure/scene_measurement.h"
#include "reference/truth/cached_tracer.h"
#include "tests/harness/render/bench_fixture.h"

namespace shadowbench::test {
namespace {

/// The flicker of `none`, as a run notes it.
double measure_flicker(const std::string& scene_name, const std::string& fit, bool snap) {
  options::RunOptions options;
  options.width = 160;
  options.height = 90;
  options.fit = scene::parse_fit_rule(fit);
  options.snap = snap;
  options.rounds = options::RoundLimits::exactly(1);
  const scene::Scene scene = load_builtin(scene_name);
  measure::Renderer renderer = measure::make_renderer(gl::Backend::kAuto, options::find_resources());
  truth::TruthCache cache({}, [](const std::string&) {});
  measure::SceneAssets assets(renderer, options, scene, cache, 4.0);
  const scene::Camera& camera = scene.cameras.front();
  const measure::SceneTask task{&scene, &camera, 512, catalogue().parse_requests("none")};
  options.reference = task.filters.front();
  measure::MeasuredCell cell = std::move(measure::measure_scene({renderer, options, task, assets}).cells.front());
  measure::score(cell.record, {cell.visibility, cell.phases, cell.stepped, cell.picture}, assets.truth(camera));
  return cell.record.error.flicker.value();
}

TEST(Flicker, OfASnappedMapUnderAStandingSun_IsNothingToTheBit) {
  for (const char* fit : {"cascades:count=4,split=logarithmic", "view"}) {
    EXPECT_EQ(measure_flicker("avenue", fit, true), 0.0) << fit;
    EXPECT_GT(measure_flicker("avenue", fit, false), 0.02) << fit;
  }
}

TEST(Flicker, OfAMapThatNoCameraMoves_IsThatUnderATurningLight) {
  EXPECT_GT(measure_flicker("avenue", "tight", true), 0.02);
  EXPECT_EQ(measure_flicker("lamp", "view", false), measure_flicker("lamp", "tight", false));
}

}  // namespace
}  // namespace shadowbench::test
