#pragma once

#include <optional>
#include <vector>

#include "harness/render/filter_passes.h"
#include "harness/stress/axis.h"

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
scene::Scene load_drawn_scene(const StressContext& context, const std::string& name, const DrawingSize& size = {});

/// One filter behind the whole chain that `run` has: light fit, depth pass, G-buffer, prefilter, lookup, with the
/// default bias.
class SceneDrawer {
 public:
  /// Requires context.renderer, which outlives the drawer. Nothing is compiled or allocated before the first drawing.
  SceneDrawer(const StressContext& context, filters::FilterRequest request, const DrawingSize& size = {});

  /// Draws a scene as its first camera sees it. Throws Error as render::FilterPasses and render::ShadowMap.
  Drawing draw(const scene::Scene& scene);

  /// Gives the frustum that the scene's light gets here.
  scene::LightFrustum fit(const scene::Scene& scene) const;

  const DrawingSize& size() const { return size_; }

 private:
  struct Stage {
    explicit Stage(const DrawingSize& size)
        : map(size.map), gbuffer(size.width, size.height), target("stress drawing", GL_R32F, size.width, size.height) {}
    render::ShadowMap map;
    render::GBuffer gbuffer;
    render::ImageTarget target;
  };

  render::ShaderLibrary& shaders_;
  std::uint32_t seed_;
  filters::FilterRequest request_;
  DrawingSize size_;
  std::optional<Stage> stage_;
  std::optional<render::FilterPasses> passes_;

  void prepare(const render::LightSetup& light);
};

/// A pixel of two drawings that should be equal differs where visibility does by more than this.
inline constexpr double kVisibleDifference = 0.1;

/// Judges a drawing by the share of its pixels that differ from what is expected: broken where a visibility is NaN or
/// infinite, or where all that was drawn is lit or dark although it should not be; degraded where the share is over the
/// bound.
Observation judge_drawing(const Drawing& seen, const Drawing& expected, double bound);

}  // namespace shadowbench::stress
