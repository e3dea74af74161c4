#include "harness/tune/tune_scene.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <glm/gtx/rotate_vector.hpp>

#include "base/error.h"
#include "harness/measure/cell_analysis.h"
#include "harness/measure/scene_truth.h"
#include "harness/measure/stability_meter.h"
#include "harness/render/picture_passes.h"
#include "report/images/picture_io.h"

namespace shadowbench::tune {
namespace {

glm::vec3 turn(const glm::vec3& v, double degrees) {
  return glm::vec3(glm::rotateY(glm::dvec3(v), glm::radians(degrees)));
}

using metrics::ErrorStats;

constexpr TuneMetric kMetrics[] = {
    {"rmse", TuneMetricKind::kStatistic, &ErrorStats::rmse},
    {"mae", TuneMetricKind::kStatistic, &ErrorStats::mae},
    {"p95", TuneMetricKind::kStatistic, &ErrorStats::p95},
    {"flip", TuneMetricKind::kFlip, nullptr},
    {"leak", TuneMetricKind::kLeak, nullptr},
    {"acne", TuneMetricKind::kAcne, nullptr},
};

/// The pictures of one view.
struct Shot {
  images::Image visibility;
  images::Image picture;   ///< only for FLIP
  images::Image unbiased;  ///< visibility without any bias; only for leaks
};

double score_statistic(const TuneMetric& metric, images::Image visibility, const measure::SceneTruth& truth) {
  for (std::size_t i = 0; i < visibility.texels.size(); ++i)
    if (!std::isfinite(visibility.texels[i])) visibility.texels[i] = truth.area.texels[i] > 0.5f ? 0.0f : 1.0f;
  const auto stats = metrics::measure_error(visibility.texels, truth.area.texels, truth.mask);
  return stats ? (*stats).*metric.statistic : kWorstError;
}

double score_shot(const TuneMetric& metric, const Shot& shot, const TuneScene::View& view) {
  const std::vector<float>& image = shot.visibility.texels;
  switch (metric.kind) {
    case TuneMetricKind::kStatistic: return score_statistic(metric, shot.visibility, *view.truth);
    case TuneMetricKind::kFlip:
      return measure::measure_mean_flip(measure::view_picture(images::round_to_half(shot.picture)),
                                        view.truth->area_seen)
          .value_or(kWorstError);
    case TuneMetricKind::kAcne:
      return metrics::rate_acne(image, view.truth->rays.area.visibility, view.masks->acne).value_or(kWorstError);
    case TuneMetricKind::kLeak:
      return metrics::rate_leak(image, shot.unbiased.texels, view.masks->leak).value_or(kWorstError);
  }
  return kWorstError;
}

bool is_artefact(TuneMetricKind kind) { return kind == TuneMetricKind::kAcne || kind == TuneMetricKind::kLeak; }

}  // namespace

std::string TuneView::name() const {
  std::vector<std::string> turns;
  if (camera_turn_deg != 0.0) turns.push_back(fmt::format("camera {:+g}", camera_turn_deg));
  if (light_turn_deg != 0.0) turns.push_back(fmt::format("light {:+g}", light_turn_deg));
  return turns.empty() ? "as it is" : fmt::format("{}", fmt::join(turns, " "));
}

const std::vector<TuneView>& tune_views() {
  static const std::vector<TuneView> views = {
      {-20.0, 0.0, true}, {0.0, 0.0, true},   {20.0, 0.0, true},   {-30.0, 0.0, false}, {-10.0, 0.0, false},
      {10.0, 0.0, false}, {30.0, 0.0, false}, {0.0, -15.0, false}, {0.0, 15.0, false},
  };
  return views;
}

std::string describe_tune_views(bool training) {
  std::vector<std::string> names;
  for (const TuneView& view : tune_views())
    if (view.training == training) names.push_back(view.name());
  return fmt::format("{}", fmt::join(names, ", "));
}

glm::vec3 find_pivot(const scene::Scene& scene, const scene::Camera& camera) {
  const scene::Bounds bounds = scene.bounds();
  const glm::vec3& eye = camera.position_ws;
  if (glm::all(glm::greaterThan(eye, bounds.min)) && glm::all(glm::lessThan(eye, bounds.max))) return eye;
  const glm::vec3 middle = 0.5f * (bounds.min + bounds.max);
  const float distance = glm::dot(middle - eye, camera.forward_ws);
  return distance > 0.0f ? eye + distance * camera.forward_ws : middle;
}

scene::Camera turn_camera(const scene::Camera& camera, const glm::vec3& pivot_ws, double degrees) {
  scene::Camera turned = camera;
  if (degrees == 0.0) return turned;
  turned.position_ws = pivot_ws + turn(camera.position_ws - pivot_ws, degrees);
  turned.forward_ws = glm::normalize(turn(camera.forward_ws, degrees));
  turned.up_ws = glm::normalize(turn(camera.up_ws, degrees));
  return turned;
}

scene::Scene turn_scene(const scene::Scene& scene, const std::vector<TuneView>& views) {
  assert(!views.empty());
  scene::Scene turned = scene;
  const scene::Camera& camera = scene.cameras.front();
  const glm::vec3 pivot = find_pivot(scene, camera);
  turned.cameras.clear();
  for (const TuneView& view : views) {
    assert(view.light_turn_deg == views.front().light_turn_deg);
    scene::Camera& added = turned.cameras.emplace_back(turn_camera(camera, pivot, view.camera_turn_deg));
    added.name = view.name();
  }
  const double light_turn = views.front().light_turn_deg;
  if (light_turn != 0.0)
    turned.light =
        scene::turn_light(scene.light, [&](const glm::vec3& v) { return glm::normalize(turn(v, light_turn)); });
  return turned;
}

const TuneMetric& find_tune_metric(const std::string& name) {
  for (const TuneMetric& metric : kMetrics)
    if (metric.name == name) return metric;
  throw Error(ErrorKind::kUsage, fmt::format("--metric: nothing is tuned for '{}'; choose {}", name,
                                             fmt::join(list_tune_metrics(), ", ")));
}

std::vector<std::string> list_tune_metrics() {
  std::vector<std::string> names;
  for (const TuneMetric& metric : kMetrics) names.emplace_back(metric.name);
  return names;
}

TuneScene::TuneScene(measure::Renderer& renderer, const TuneSettings& settings, truth::TruthCache& cache,
                     const scene::Scene& scene, const std::vector<TuneView>& views,
                     const std::function<void(const std::string&)>& on_view)
    : renderer_(renderer),
      settings_(settings),
      options_(*settings.options),
      scene_(turn_scene(scene, views)),
      assets_(renderer, options_, scene_, cache, settings.pad_texels),
      target_("visibility", GL_R32F, settings.options->width, settings.options->height) {
  const std::int64_t own = count_receivers(scene.cameras.front());
  for (const scene::Camera& camera : scene_.cameras) {
    if (const std::int64_t count = count_receivers(camera); 2 * count < own) {
      left_out_.push_back(fmt::format("{}, {}: {} receivers, less than half the {} of the scene's own view",
                                      scene_.name, camera.name, count, own));
      continue;
    }
    on_view(fmt::format("truth of {}, {}", scene_.name, camera.name));
    measure::LightMap& light = assets_.light_map(camera, settings.options->map_sizes.front());
    View view{&camera, &assets_.truth(camera), &light, std::nullopt};
    if (view.truth->absent.empty() && is_artefact(settings.metric->kind))
      view.masks = measure::find_artefact_masks(
          assets_.tracer(),
          measure::list_traced_layers(renderer.shaders, assets_.gbuffer(camera),
                                      measure::make_unbiased_light(*settings.options, scene_.light, light.layers)),
          *view.truth, settings.pad_texels);
    const std::string reason = explain_absent(view);
    if (reason.empty())
      views_.push_back(std::move(view));
    else
      left_out_.push_back(fmt::format("{}, {}: {}", scene_.name, camera.name, reason));
  }
}

std::string TuneScene::explain_absent(const View& view) const {
  if (!view.masks) return view.truth->absent;
  const bool acne = settings_.metric->kind == TuneMetricKind::kAcne;
  const std::vector<std::uint8_t>& mask = acne ? view.masks->acne : view.masks->leak;
  const auto count = std::count(mask.begin(), mask.end(), 1);
  if (count >= metrics::kFewestReceivers) return {};
  return fmt::format("{} receivers are wholly {} with their surroundings, and a rate of {} needs {}", count,
                     acne ? "lit" : "blocked", settings_.metric->name, metrics::kFewestReceivers);
}

std::int64_t TuneScene::count_receivers(const scene::Camera& camera) {
  return std::ranges::count(measure::read_view_receivers(assets_.gbuffer(camera), scene_.light).mask(), 1);
}

render::LightLayers TuneScene::make_light(const filters::FilterRequest& request, const measure::LightMap& light) const {
  return measure::make_filter_light(options_, scene_.light, light.layers, request);
}

void TuneScene::refit(const scene::CascadeRule& cascades) {
  if (cascades == options_.fit.cascades) return;
  options_.fit.cascades = cascades;
  const glm::dvec2 shift = measure::list_phase_shifts(options_.phases, options_.seed).front();
  for (const View& view : views_)
    *view.light = assets_.make_light_map(scene_.light, *view.camera, options_.map_sizes.front(), shift);
}

render::FilterPasses TuneScene::make_passes(const filters::FilterRequest& request) {
  const measure::LightMap& light = *views_.front().light;
  return render::FilterPasses(renderer_.shaders, request, light.map, make_light(request, light));
}

std::optional<std::vector<double>> TuneScene::score(render::FilterPasses& passes, const Setting& setting) {
  refit(setting.cascades);
  filters::FilterRequest request = passes.request();
  request.values = setting.values;
  std::vector<Shot> shots(views_.size());
  const measure::LightMap* drawn = nullptr;
  for (std::size_t i = 0; i < views_.size(); ++i) {
    measure::LightMap& light = *views_[i].light;
    if (drawn != &light) {
      passes.retune(setting.values, make_light(request, light));
      passes.prefilter(light.map);
      if (measure::count_broken_texels(passes, light.map) > 0) return std::nullopt;
    }
    drawn = &light;
    render::GBuffer& gbuffer = assets_.gbuffer(*views_[i].camera);
    passes.lookup(gbuffer, light.map, target_);
    shots[i].visibility = render::read_image(target_.texture(), 1);
    if (settings_.metric->kind == TuneMetricKind::kFlip)
      shots[i].picture = render::shade(renderer_.shaders, gbuffer, target_.texture(), scene_, *views_[i].camera);
    if (settings_.metric->kind != TuneMetricKind::kLeak) continue;
    measure::draw_without_bias(options_, assets_, light, passes, [&] {
      shots[i].unbiased = measure::draw_visibility(passes, light.map, gbuffer, target_);
    });
    drawn = nullptr;  // the prefilter is that of the map without bias
  }
  std::vector<double> scores(views_.size());
  tbb::parallel_for(std::size_t{0}, scores.size(),
                    [&](std::size_t i) { scores[i] = score_shot(*settings_.metric, shots[i], views_[i]); });
  return scores;
}

}  // namespace shadowbench::tune
