#pragma once

#include <string>
#include <vector>

#include "harness/stress/case_tools.h"
#include "harness/stress/filter_stage.h"

namespace shadowbench::stress {

/// What a camera sees of a scene's shadows; rows bottom to top.
struct Drawing {
  std::vector<float> visibility;
  std::vector<glm::vec4> position;  ///< world space, view depth; view depth 0: nothing was drawn
};

/// Sizes of what is drawn: small, since a stress axis draws hundreds of them.
struct DrawingSize {
  int width = 160;
  int height = 120;
  int map = 256;  ///< texels per side
};

/// Loads a built-in scene, framed for drawings of this size. Throws Error as scene::load().
scene::Scene load_drawn_scene(const AxisInputs& inputs, const std::string& name, const DrawingSize& size = {});

/// Draws one filter with all passes that `run` has: light fit, depth map, G-buffer, prefilter and lookup, with the
/// default bias.
class SceneDrawer {
 public:
  /// Requires inputs.renderer, which outlives the drawer. Nothing is compiled or allocated before the first drawing.
  SceneDrawer(const AxisInputs& inputs, filters::FilterRequest request, const DrawingSize& size = {});

  /// Draws a scene as its first camera sees it. Throws Error as render::FilterPasses and render::ShadowMap.
  Drawing draw(const scene::Scene& scene);

  /// The frustum that the scene's light gets here.
  scene::LightFrustum fit(const scene::Scene& scene) const;

  const DrawingSize& size() const { return size_; }

 private:
  std::uint32_t seed_;
  DrawingSize size_;
  FilterStage stage_;
};

/// A pixel of two drawings that should be equal differs where visibility does by more than this.
inline constexpr double kVisibleDifference = 0.1;

/// Judges a drawing by the share of its pixels that differ from what is expected. It is broken where a visibility is
/// NaN or infinite, and where all that was drawn is lit or dark although it should not be. It is degraded where the
/// share is over the bound.
Observation judge_drawing(const Drawing& seen, const Drawing& expected, double bound);

}  // namespace shadowbench::stress
