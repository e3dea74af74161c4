#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "harness/flicker/motion.h"
#include "harness/run/filter_setup.h"
#include "harness/run/scene_assets.h"
#include "harness/run/view_receivers.h"
#include "reference/metrics/flicker.h"

namespace shadowbench::flicker {

/// What rays say of every frame.
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
  FlickerBench(run::Renderer& renderer, const run::RunOptions& options, const scene::Scene& scene,
               run::TruthCache& cache);

  /// Gives how the map follows: the padding of the widest kernel, as a run has it.
  MapFollowing following(bool snap) const;

  const run::ViewReceivers& receivers() const { return receivers_; }

  /// Traces every frame of a moving light; where the light stands still nothing changes, and nothing is traced.
  /// `on_frame` hears of each.
  TruthFrames trace(Motion motion, const std::vector<Frame>& frames, const std::vector<std::uint8_t>& mask,
                    const std::function<void(int)>& on_frame);

  /// Draws every frame with every filter. Requires a mask with a receiver in it, and a truth for every frustum.
  std::vector<reference::FlickerStats> measure(const std::vector<scene::LightFrustum>& frusta,
                                               const std::vector<std::uint8_t>& mask, const TruthFrames& truth,
                                               const std::function<void(int)>& on_frame);

 private:
  run::Renderer& renderer_;
  const run::RunOptions& options_;
  const scene::Scene& scene_;
  run::SceneAssets assets_;
  run::LightMap map_;
  render::ImageTarget target_;
  run::ViewReceivers receivers_;
  std::vector<std::unique_ptr<render::FilterPasses>> filters_;
  scene::Scene turned_;  ///< the scene under the frame's light
  run::SceneTracer turned_tracer_;

  const scene::Camera& camera() const { return scene_.cameras.front(); }
  report::Image draw(render::FilterPasses& filter);
};

}  // namespace shadowbench::flicker
