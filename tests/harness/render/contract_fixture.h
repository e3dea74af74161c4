#pragma once

#include <cmath>
#include <cstdint>

#include "filters/front_matter.h"
#include "harness/render/geometry.h"
#include "harness/scene/scene.h"
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
inline filters::FilterRequest find_filter(const std::string& text) {
  return all_filters().parse_requests(text).front();
}

inline bool is_stochastic(const filters::FilterRequest& request) {
  return request.spec.kind == filters::FilterKind::kStochastic;
}

/// Draws visibility once per seed 1, 2, ..., `seeds`, each as Bench::draw gives it.
inline std::vector<std::vector<float>> draw_seeds(Bench& bench, const filters::FilterRequest& request,
                                                  std::uint32_t seeds) {
  render::LightLayers light = bench.light(request);
  render::FilterPasses passes(bench.shaders(), request, bench.map(), light);
  std::vector<std::vector<float>> images;
  for (std::uint32_t seed = 1; seed <= seeds; ++seed) {
    for (render::LightSetup& layer : light) layer.seed = seed;
    passes.retune(request.values, light);
    images.push_back(bench.draw(passes));
  }
  return images;
}

inline std::string name_of(const ::testing::TestParamInfo<std::string>& each) { return each.param; }

/// A rectangle that hangs over the floor, in texels of the map from its middle, along u and v.
struct Caster {
  glm::vec2 low;
  glm::vec2 high;
  float height = 24.0f;  ///< over the floor, as long as so many texels are wide
};

/// Pixels per texel, per axis. Their centres keep a sixteenth of a texel off every border of a texel and off its
/// centre, so that no rounding decides which texel a filter reads, whichever way ties fall there.
inline constexpr int kPixelsPerTexel = 8;

/// A floor under a light from straight above, seen straight from above: a pixel is an eighth of a texel. A metre is a
/// texel, and the light's frustum is frozen, so that it does not follow casters.
class AnalyticFloor {
 public:
  /// Makes a floor with room for a kernel of `radius_texels` on both sides of the view's middle.
  AnalyticFloor(double radius_texels, const std::vector<Caster>& casters)
      : view_(view_texels(radius_texels)),
        map_(4 * view_),
        scene_(make_scene(casters)),
        bench_(scene_, map_, pixels(), pixels()) {}

  /// Gives how many texels are in view, per side, where a kernel of this half-width is to be seen.
  static int view_texels(double radius_texels) { return 2 * static_cast<int>(std::ceil(radius_texels)) + 8; }

  int pixels() const { return view_ * kPixelsPerTexel; }  ///< per side of the view
  Bench& bench() { return bench_; }

 private:
  static constexpr float kNear = 32.0f, kFar = 8.0f;  ///< of the map's planes, over and under the floor
  static constexpr float kCamera = 4.0f;              ///< over the floor, and under all casters

  int view_;
  int map_;
  scene::Scene scene_;
  Bench bench_;

  /// The light's u runs along -x, its v along z.
  static scene::Mesh make_rectangle(const glm::vec2& low, const glm::vec2& high, float height) {
    const glm::vec2 middle = 0.5f * (low + high);
    return scene::move_mesh(scene::make_plane(high - low, 4), glm::vec3(-middle.x, height, middle.y));
  }

  scene::Scene make_scene(const std::vector<Caster>& casters) const {
    const glm::vec2 half(0.5f * static_cast<float>(map_));
    std::vector<scene::Mesh> meshes = {make_rectangle(-half, half, 0.0f)};
    for (const Caster& c : casters)
      meshes.push_back(make_rectangle(glm::max(c.low, -half), glm::min(c.high, half), c.height));
    scene::Scene scene =
        scene::make_scene_of(meshes, scene::kSunAtZenith,
                             {scene::make_camera({0.0f, kCamera, 0.0f}, {0.0f, -1.0f, 0.0f}, {0.0f, 0.0f, 1.0f})});
    scene.cameras.front().vertical_fov_rad = 2.0f * std::atan(0.5f * static_cast<float>(view_) / kCamera);
    scene.light.map_window =
        scene::MapWindow{{0.0, 0.0, 0.0}, static_cast<double>(map_), scene::MapWindow::Planes{-kNear, kFar}};
    return scene::validate(scene, "analytic floor");
  }
};

/// A mean with what it may be off by.
struct Estimate {
  double mean = 0.0;
  double slack = 0.0;
};

/// Chance that a whole test of the contract fails although the filter keeps it; every estimate in it gets its share
/// (Bonferroni).
inline constexpr double kTestLevel = 1e-4;

/// Collects independent values in [0,1] and bounds how far their mean is from its expectation.
class MeanInUnitInterval {
 public:
  void add(double value) {
    ++count_;
    sum_ += value;
    squares_ += value * value;
  }

  double mean() const { return sum_ / count_; }

  /// Gives the bound that holds for all of `tests` such means but with the chance kTestLevel. Holds for any
  /// distribution, also where values are not distributed alike: their spread then counts as variance. Requires two
  /// values or more. Source: Maurer and Pontil 2009, Empirical Bernstein Bounds and Sample Variance Penalization, COLT,
  /// theorem 4, on both sides.
  double slack(double tests) const {
    const double variance = std::max(squares_ - sum_ * sum_ / count_, 0.0) / (count_ - 1.0);
    const double log_chance = std::log(4.0 * tests / kTestLevel);
    return std::sqrt(2.0 * variance * log_chance / count_) + 7.0 * log_chance / (3.0 * (count_ - 1.0));
  }

 private:
  double count_ = 0.0;
  double sum_ = 0.0;
  double squares_ = 0.0;
};

}  // namespace shadowbench::test
