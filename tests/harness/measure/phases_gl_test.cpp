// Whether the interval over phases covers what another place of the map's grid would have given.

#include "filters/format/front_matter.h"
#include "harness/measure/filter_setup.h"
#include "harness/measure/scene_measurement.h"
#include "harness/measure/timing/statistics.h"
#include "harness/measure/timing/timing.h"
#include "reference/metrics/error_stats.h"
#include "reference/truth/truth_cache.h"
#include "tests/harness/render/bench_fixture.h"

namespace shadowbench::test {
namespace {

constexpr int kPhasedMapSize = 512;

/// A scene with its truth, small.
class Phased {
 public:
  explicit Phased(const std::string& scene)
      : scene_(load_builtin(scene)),
        renderer_(measure::make_renderer(gl::Backend::kAuto, options::find_resources())),
        cache_({}, [](const std::string&) {}),
        assets_(renderer_, options_, scene_, cache_, 6.0) {}

  /// The RMSE of a filter over the phases, all moved by `shift` texels.
  metrics::MeanInterval measure(const filters::FilterRequest& request, const glm::dvec2& shift) {
    const scene::Camera& camera = scene_.cameras.front();
    const measure::SceneTruth& truth = assets_.truth(camera);
    render::ImageTarget target("visibility", GL_R32F, options_.width, options_.height);
    std::vector<double> errors;
    for (const glm::dvec2& phase : measure::list_phase_shifts(options_.phases)) {
      const measure::LightMap map = assets_.make_light_map(scene_.light, camera, kPhasedMapSize, phase + shift);
      const auto passes = measure::make_filter_passes(renderer_, options_, scene_, map, request);
      const images::Image image = measure::draw_visibility(*passes, map.map, assets_.gbuffer(camera), target);
      errors.push_back(metrics::measure_error(image.texels, truth.area.texels, truth.mask)->rmse);
    }
    return *metrics::find_mean_interval(errors);
  }

  /// The own time of a filter, as records hold it.
  records::OwnTime time(const filters::FilterRequest& request) {
    const scene::Camera& camera = scene_.cameras.front();
    measure::LightMap& map = assets_.light_map(camera, kPhasedMapSize);
    const auto passes = measure::make_filter_passes(renderer_, options_, scene_, map, request);
    render::ImageTarget target("visibility", GL_R32F, options_.width, options_.height);
    measure::draw_visibility(*passes, map.map, assets_.gbuffer(camera), target);
    const std::vector<render::FilterPasses*> filters = {passes.get()};
    const auto empty = measure::make_empty_lookups(renderer_, options_, scene_, map, filters);
    const measure::RoundTimes times = measure::time_rounds({.filters = filters,
                                                            .empties = empty.passes,
                                                            .draw_map = [&] { assets_.redraw(map); },
                                                            .map = map.map,
                                                            .gbuffer = assets_.gbuffer(camera),
                                                            .timer = renderer_.timer},
                                                           {.limits = options::RoundLimits::exactly(40)});
    return measure::bootstrap_difference(times.filters[0].lookup, times.empties[0], 1);
  }

 private:
  scene::Scene scene_;
  options::RunOptions options_ = make_options();
  measure::Renderer renderer_;
  truth::TruthCache cache_;
  measure::SceneAssets assets_;

  static options::RunOptions make_options() {
    options::RunOptions options;
    options.width = 320;
    options.height = 180;
    return options;
  }
};

// Moved by half a texel along one axis or both, no mean leaves its interval but one in twenty.
TEST(Phases, AShiftOfTheMap_MovesNoErrorByMoreThanItsInterval) {
  int moved = 0, shifts = 0;
  for (const std::string& scene : builtin_scenes()) {
    Phased phased(scene);
    for (const std::string filter : {"none", "pcf2x2", "tent3x3", "vsm"}) {
      const auto request = catalogue().parse_requests(filter).front();
      const metrics::MeanInterval own = phased.measure(request, {0.0, 0.0});
      for (const glm::dvec2 shift : {glm::dvec2(0.5, 0.0), glm::dvec2(0.0, 0.5), glm::dvec2(0.5, 0.5)}) {
        const double mean = phased.measure(request, shift).mean;
        ++shifts;
        if (mean >= own.low && mean <= own.high) continue;
        ++moved;
        std::printf("%s %s, moved by %g %g: %.6f is not in [%.6f, %.6f]\n", scene.c_str(), filter.c_str(), shift.x,
                    shift.y, mean, own.low, own.high);
      }
    }
  }
  std::printf("%d of %d shifts leave the interval\n", moved, shifts);
  EXPECT_LE(20 * moved, shifts);
}

/// A filter of the user's that returns this expression.
filters::FilterRequest make_filter(const std::string& expression) {
  filters::FilterRequest request;
  request.spec = filters::parse_filter(
      "/*+++\ntitle = \"t\"\nsource = \"s\"\nkind = \"other\"\n+++*/\n"
      "float visibility(Receiver r) { return " +
          expression + "; }\n",
      "test.glsl");
  return request;
}

// A 95 % interval misses now and then: of three, one must hold 0.
TEST(OwnTime, OfAConstantIsNothing) {
  Phased phased("cubes");
  bool holds_nothing = false;
  for (int attempt = 0; attempt < 3 && !holds_nothing; ++attempt) {
    const records::OwnTime time = phased.time(make_filter("0.5"));
    std::printf("constant: %.4f ms [%.4f, %.4f]\n", time.median, time.ci95.low, time.ci95.high);
    holds_nothing = time.ci95.low <= 0.0 && time.ci95.high >= 0.0;
  }
  EXPECT_TRUE(holds_nothing);
}

TEST(OwnTime, OfAComparisonIsMoreThanNothing) {
  const records::OwnTime time = Phased("cubes").time(make_filter("compare_2x2(r, vec2(0.0), r.depth)"));
  EXPECT_GT(time.ci95.low, 0.0);
}

TEST(OwnTime, EmptyLookupsReadWhatTheirFiltersRead) {
  Phased phased("cubes");
  const records::OwnTime time = phased.time(make_filter("r.normal_ws.x + r.position_ws.y + r.n_dot_l"));
  EXPECT_LT(std::abs(time.median), 1.0) << "ms: without the reads in the empty lookup it would be several";
}

}  // namespace
}  // namespace shadowbench::test
