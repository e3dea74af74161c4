#pragma once

#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "harness/measure/scene_assets.h"
#include "harness/render/filter_passes.h"
#include "harness/scene/scene.h"
#include "reference/metrics/artefacts.h"
#include "reference/metrics/error_stats.h"

namespace shadowbench::tune {

/// A way to look at a scene other than its own: from elsewhere, or under another light.
struct TuneView {
  double camera_turn_deg = 0.0;  ///< of the first camera, about the vertical axis through find_pivot()
  double light_turn_deg = 0.0;   ///< added to the light's azimuth
  bool training = false;         ///< parameters are chosen by it; else they are only scored on it

  /// Names the turn: "camera +20", "light -15", "as it is".
  std::string name() const;
};

/// The views that every scene is tuned on and scored on: the one list of them.
const std::vector<TuneView>& tune_views();

/// Says in words which views those are.
std::string describe_tune_views(bool training);

/// The point of a camera's central ray that is nearest to the middle of the scene's bounds; where that lies
/// behind the camera, the middle itself. Of a camera that stands within the bounds its own place: elsewhere it might
/// stand in a wall, or beside the ground.
glm::vec3 find_pivot(const scene::Scene& scene, const scene::Camera& camera);

/// A camera turned about the vertical axis through a point; positive turns it as an azimuth grows, from +z to +x.
scene::Camera turn_camera(const scene::Camera& camera, const glm::vec3& pivot_ws, double degrees);

/// The scene under its light turned, with one camera for each of the views, in their order, named for them.
/// Requires that all views turn the light alike.
scene::Scene turn_scene(const scene::Scene& scene, const std::vector<TuneView>& views);

/// What a tuned number is made from.
enum class TuneMetricKind { kStatistic, kFlip, kAcne, kLeak };

/// A number that tuning can make small: of [0,1], 0 at best.
struct TuneMetric {
  std::string_view name;  ///< as `list metrics` has it, without its group
  TuneMetricKind kind = TuneMetricKind::kStatistic;
  double metrics::ErrorStats::*statistic =
      nullptr;  ///< of kStatistic, which are in units of visibility, as the truth's standard error
};

/// Finds a metric. Throws Error(kUsage), with those there are, where there is none of that name.
const TuneMetric& find_tune_metric(const std::string& name);

/// Names all metrics, in the order to show them.
std::vector<std::string> list_tune_metrics();

/// The worst value of every metric that is tuned.
inline constexpr double kWorstError = 1.0;

/// How tuning draws and scores, whatever the filter.
struct TuneSettings {
  const options::RunOptions* options = nullptr;  ///< one map size, no rounds
  const TuneMetric* metric = nullptr;
  double pad_texels =
      0.0;  ///< around the scene in the map, and the widest kernel that the guard of artefacts allows for
};

/// What is tuned: the parameters of a filter, and how cascades share what the camera sees.
struct Setting {
  filters::ParamValues values;
  scene::CascadeRule cascades;
};

/// One scene under one light with some of its views, ready to score any setting of any filter. Draws the views and
/// traces their truth once; scoring draws the maps where cascades are others than those of the setting before, the
/// prefilter once for each map and one lookup for each view, and times nothing. Masks stay those of the fit asked for.
class TuneScene {
 public:
  /// `on_view` hears of each view before it is traced. All but the scene must outlive this object. A view with less
  /// than half the receivers of the scene's own is left out: it shows too little of what is tuned for.
  TuneScene(measure::Renderer& renderer, const TuneSettings& settings, truth::TruthCache& cache,
            const scene::Scene& scene, const std::vector<TuneView>& views,
            const std::function<void(const std::string&)>& on_view);
  TuneScene(const TuneScene&) = delete;
  TuneScene& operator=(const TuneScene&) = delete;

  /// A view that the metric can be measured in.
  struct View {
    const scene::Camera* camera = nullptr;
    const measure::SceneTruth* truth = nullptr;
    measure::LightMap* light = nullptr;  ///< which the view shares with the others unless the fit follows the camera
    std::optional<metrics::ArtefactMasks> masks;  ///< only where the metric needs them
  };
  const std::vector<View>& views() const { return views_; }

  /// Which views cannot be scored, and why, a line for each.
  const std::vector<std::string>& left_out() const { return left_out_; }

  const scene::Scene& scene() const { return scene_; }

  /// Compiles a filter, to be scored by this and all others of the same settings.
  render::FilterPasses make_passes(const filters::FilterRequest& request);

  /// Scores a setting in every view, in the order of views(). Gives nothing where the filter's parameters
  /// overflow its map: infinite texels may hide in the image, and are not to be chosen for it. A pixel that is
  /// not finite counts as wholly wrong.
  std::optional<std::vector<double>> score(render::FilterPasses& passes, const Setting& setting);

 private:
  measure::Renderer& renderer_;
  TuneSettings settings_;
  options::RunOptions options_;  ///< with the fit of the maps that are drawn
  scene::Scene scene_;
  measure::SceneAssets assets_;
  render::ImageTarget target_;
  std::vector<View> views_;
  std::vector<std::string> left_out_;

  /// Gives why a view has no such metric; empty where it has.
  std::string explain_absent(const View& view) const;
  render::LightLayers make_light(const filters::FilterRequest& request, const measure::LightMap& light) const;
  /// Draws the maps of other cascades.
  void refit(const scene::CascadeRule& cascades);
  std::int64_t count_receivers(const scene::Camera& camera);
};

}  // namespace shadowbench::tune
