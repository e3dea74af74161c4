#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "harness/flicker/motion.h"
#include "harness/measure/filter_setup.h"
#include "harness/measure/scene_assets.h"
#include "harness/measure/view_receivers.h"
#include "reference/metrics/flicker.h"

namespace shadowbench::flicker {

/// The ray-traced visibility of every frame.
struct TruthFrames {
  std::vector<std::vector<float>> visibility;  ///< of each frame, by pixel
  double noise =
      0.0;  ///< standard error of a change, root mean square over receivers and steps, if frames were independent
  bool traced = true;
};

/// The receivers of a scene's first view, the filters, and the map they read while something moves.
class FlickerBench {
 public:
  /// Compiles every filter of the options once. Everything must outlive this object.
  /// Throws Error(kInput) where no surface in view faces the light.
  FlickerBench(measure::Renderer& renderer, const options::RunOptions& options, const scene::Scene& scene,
               truth::TruthCache& cache);

  /// How the map follows the frames; it has the padding of the widest kernel, as in a run.
  MapFollowing following(bool snap) const;

  const measure::ViewReceivers& receivers() const { return receivers_; }

  /// Traces every frame of a moving light; where the light stands still nothing changes, and nothing is traced.
  /// `on_frame` hears of each.
  TruthFrames trace(Motion motion, const std::vector<Frame>& frames, const std::vector<std::uint8_t>& mask,
                    const std::function<void(int)>& on_frame);

  /// Draws every frame with every filter. Requires a mask with a receiver in it, and a truth for every frustum.
  std::vector<metrics::FlickerStats> measure(const std::vector<scene::LightFrustum>& frusta,
                                             const std::vector<std::uint8_t>& mask, const TruthFrames& truth,
                                             const std::function<void(int)>& on_frame);

 private:
  measure::Renderer& renderer_;
  const options::RunOptions& options_;
  const scene::Scene& scene_;
  measure::SceneAssets assets_;
  measure::LightMap map_;
  render::ImageTarget target_;
  measure::ViewReceivers receivers_;
  std::vector<std::unique_ptr<render::FilterPasses>> filters_;

  const scene::Camera& camera() const { return scene_.cameras.front(); }
  images::Image draw(render::FilterPasses& filter);
};

}  // namespace shadowbench::flicker
