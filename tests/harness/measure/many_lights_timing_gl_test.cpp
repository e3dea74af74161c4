#include "harness/measure/timing/many_lights_timing.h"
#include "harness/scene/lights/light.h"
#include "reference/truth/truth_cache.h"
#include "tests/harness/render/bench_fixture.h"

namespace shadowbench::test {
namespace {

constexpr int kMapSize = 128;
constexpr double kPadTexels = 6.0;

/// Frames of several lights over a scene, with every built-in filter.
class LightFrames {
 public:
  explicit LightFrames(const std::string& scene, const std::string& filters = "")
      : scene_(load_tilted(scene)),
        renderer_(measure::make_renderer(gl::Backend::kAuto, options::find_resources())),
        cache_({}, [](const std::string&) {}),
        assets_(renderer_, options_, scene_, cache_, kPadTexels),
        requests_(catalogue().parse_requests(filters)) {
    frame_ = {&scene_.light, &scene_.cameras.front(), kMapSize, {}, 0};
    for (const auto& request : requests_) {
      passes_.push_back(make_passes(request, assets_.light_map(*frame_.camera, kMapSize), scene_.light));
      frame_.filters.push_back(passes_.back().get());
    }
  }

  measure::LightFrameBench bench(int count) { return {renderer_, options_, assets_, frame_, count}; }
  measure::LightMeasurement measure(const std::vector<int>& counts, int rounds) {
    options_.lights = counts;
    options_.rounds = options::RoundLimits::exactly(rounds);
    return measure::measure_lights(renderer_, options_, assets_, frame_);
  }

  /// What a filter draws under a light, with maps and passes that nothing else uses.
  std::vector<float> draw_alone(std::size_t filter, const scene::Light& light) {
    const measure::LightMap map = assets_.make_light_map(light, *frame_.camera, kMapSize);
    const auto passes = make_passes(requests_[filter], map, light);
    render::ImageTarget target("visibility", GL_R32F, options_.width, options_.height);
    passes->prefilter(map.map);
    passes->lookup(assets_.gbuffer(*frame_.camera), map.map, target);
    return target.texture().read_floats(1);
  }

  const scene::Scene& scene() const { return scene_; }
  const std::vector<filters::FilterRequest>& requests() const { return requests_; }

 private:
  scene::Scene scene_;
  options::RunOptions options_ = make_options();
  measure::Renderer renderer_;
  truth::TruthCache cache_;
  measure::SceneAssets assets_;
  std::vector<filters::FilterRequest> requests_;
  std::vector<std::unique_ptr<render::FilterPasses>> passes_;
  measure::LightFrame frame_;

  /// A light that is not overhead: turned about the vertical it is another.
  static scene::Scene load_tilted(const std::string& name) {
    scene::Scene scene = load_builtin(name);
    scene.light = scene::turn_light(
        scene.light, [](const glm::vec3& way) { return glm::normalize(way + glm::vec3(0.3f, 0.0f, 0.1f)); });
    return scene;
  }

  static options::RunOptions make_options() {
    options::RunOptions options;
    options.width = 96;
    options.height = 54;
    return options;
  }

  std::unique_ptr<render::FilterPasses> make_passes(const filters::FilterRequest& request, const measure::LightMap& map,
                                                    const scene::Light& light) {
    const render::Bias bias = render::resolve_bias(options_.bias, map.frustum(), request.spec, request.values);
    return std::make_unique<render::FilterPasses>(
        renderer_.shaders, request, map.map,
        render::make_light_setup(map.frustum(), light, bias, options_.seed, options_.range));
  }
};

class LightFramesOf : public ::testing::TestWithParam<const char*> {};

/// Whatever filters share, each light's image is what that light alone gives, in every order of turns.
TEST_P(LightFramesOf, EveryLight_DrawsTheSameBitsAsAlone) {
  LightFrames frames(GetParam());
  measure::LightFrameBench bench = frames.bench(3);
  const std::vector<scene::Light> lights = scene::make_light_ring(frames.scene().light, 3);
  for (int turn = 0; turn < 2; ++turn) {
    for (std::size_t filter = 0; filter < frames.requests().size(); ++filter) {
      SCOPED_TRACE(frames.requests()[filter].spec.id);
      const auto pictures = bench.draw(filter);
      ASSERT_EQ(pictures.size(), 3u);
      for (std::size_t i = 0; i < lights.size(); ++i)
        EXPECT_EQ(pictures[i], frames.draw_alone(filter, lights[i])) << "light " << i;
      EXPECT_NE(pictures[0], pictures[1]);
    }
  }
}

// On "edge" the map's edge cuts casters: what lies outside it is seen. The maps of a lamp's ring curve depth in several
// ways.
INSTANTIATE_TEST_SUITE_P(Scenes, LightFramesOf, ::testing::Values("fence", "edge", "lamp"));

TEST(LightTiming, TimesEveryPassOnce_OfFiltersThatNeedIt) {
  LightFrames frames("cubes", "none,vsm");
  const measure::LightMeasurement measured = frames.measure({1, 2}, 3);
  ASSERT_EQ(measured.filters.size(), 2u);
  for (const auto& filter : measured.filters) {
    ASSERT_EQ(filter.size(), 2u);
    EXPECT_EQ(filter[0].count, 1);
    EXPECT_EQ(filter[1].count, 2);
    for (const records::LightCountRecord& each : filter) {
      EXPECT_EQ(each.static_ms.n, 3);
      EXPECT_EQ(each.moving_ms.n, 3);
      EXPECT_GT(each.moving_ms.median, each.static_ms.median);
    }
  }
  EXPECT_EQ(measured.filters[0][1].static_ratio.median, 1.0);
  EXPECT_EQ(measured.filters[0][1].moving_ratio.ci95.high, 1.0);
  EXPECT_GT(measured.spent_ms, 0.0);
  measure::LightFrameBench bench = frames.bench(2);
  const measure::RoundTimes times = bench.time();
  EXPECT_EQ(times.map.size(), 3u);
  EXPECT_TRUE(times.filters[0].prefilter.empty());
  EXPECT_EQ(times.filters[1].prefilter.size(), 3u);
}

/// Eight lights are eight times the passes; half of that is beyond any noise.
TEST(LightTiming, MoreLights_TakeLonger_StillAndMoving) {
  LightFrames frames("cubes", "none,vsm");
  const measure::LightMeasurement measured = frames.measure({1, 8}, 9);
  for (const auto& filter : measured.filters) {
    EXPECT_GT(filter[1].static_ms.median, 4.0 * filter[0].static_ms.q1);
    EXPECT_GT(filter[1].moving_ms.median, 4.0 * filter[0].moving_ms.q1);
  }
}

}  // namespace
}  // namespace shadowbench::test
