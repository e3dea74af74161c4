#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "harness/measure/renderer.h"
#include "harness/measure/scene_assets.h"
#include "harness/measure/timing/timing.h"
#include "harness/options/options.h"
#include "harness/render/filter_passes.h"
#include "harness/scene/scene.h"
#include "report/records/records.h"

namespace shadowbench::measure {

/// A frame's view and map size, and the filters that take turns in it.
struct LightFrame {
  const scene::Light* light = nullptr;  ///< the first; the others are scene::make_light_ring()'s
  const scene::Camera* camera = nullptr;
  int map_size = 1024;
  std::vector<render::FilterPasses*> filters;
  std::size_t reference = 0;  ///< index of the filter that ratios refer to
};

/// Draws and times frames lit by one number of lights. Each light has its own frustum and depth map, fitted and biased
/// as the scene's own light is, and each filter that encodes has a map for every light. Filters that store the same
/// format take turns in the same encoded maps: in its turn a filter writes all of them before it reads them, so that
/// sharing saves memory and no work.
class LightFrameBench {
 public:
  /// Everything must outlive this object; `count` is 1 or more. Cost: `count` maps and fits.
  LightFrameBench(Renderer& renderer, const options::RunOptions& options, SceneAssets& assets, const LightFrame& frame,
                  int count);

  /// Times interleaved rounds as run_rounds(): `map` has the time of all lights' depth maps, a filter's `prefilter`
  /// that of all its encoded maps, its `lookup` that of one lookup per light, each over the whole picture. Shading and
  /// adding up are left out.
  RoundTimes time();

  /// Runs a filter's prefilters and lookups; gives each light's visibility as the GL wrote it, rows bottom to top.
  std::vector<std::vector<float>> draw(std::size_t filter);

 private:
  Renderer& renderer_;
  const options::RunOptions& options_;
  SceneAssets& assets_;
  LightFrame frame_;
  render::GBuffer& gbuffer_;
  std::vector<std::unique_ptr<render::ImageTarget>>
      targets_;  ///< one a light: what the next one overwrites need not be drawn
  std::vector<LightMap> maps_;
  std::vector<std::vector<render::PreparedLight>> prepared_;  ///< by filter and light

  void prepare_filters(const std::vector<scene::Light>& lights);
  void prefilter(std::size_t filter);
  void look_up(std::size_t filter);
};

/// What frames of every number of lights cost.
struct LightMeasurement {
  std::vector<std::vector<records::LightCountRecord>>
      filters;            ///< of each filter, in the order given, by ascending count
  double spent_ms = 0.0;  ///< of all passes, rounds that warm up included
};

/// Measures what frames lit by each of `options.lights` cost. The filters are left turned to the last light.
/// Cost: rounds of map, prefilter and lookup, times the sum of the counts.
LightMeasurement measure_lights(Renderer& renderer, const options::RunOptions& options, SceneAssets& assets,
                                const LightFrame& frame);

}  // namespace shadowbench::measure
