#pragma once

#include <array>
#include <optional>

#include "harness/render/gbuffer.h"
#include "harness/render/image_target.h"

namespace shadowbench::render {

/// How frames are accumulated.
struct ResolveRule {
  float least_weight = 0.1f;  ///< of the newest frame; that of the n-th is 1/n at least: 0 is the plain mean, 1 no mean
  bool clamps = true;         ///< what was resolved before stays within this frame's 3x3 pixels around
};

/// A picture whose visibility is added.
struct ResolvedFrame {
  const GBuffer& gbuffer;
  const gl::Texture& visibility;  ///< R32F, of the G-buffer's size
  const scene::Camera& camera;    ///< without jitter
};

/// Accumulates visibility over frames, as temporal antialiasing does with colours: an exponential mean of what was
/// resolved at the same point of a surface, which the G-buffer's positions find again. A point starts anew that lay
/// outside the picture or was hidden: no 3x3 pixels there showed depths around its own.
/// Source: Karis 2014, High-Quality Temporal Supersampling, SIGGRAPH; weights of 1/n at first: Schied et al. 2017,
/// Spatiotemporal Variance-Guided Filtering, HPG. Surfaces that move are found where they were not: we move none.
class ResolvePass {
 public:
  ResolvePass(ResolveRule rule, int width, int height);

  /// Adds a frame. Cost: one pass over the picture.
  void add(ShaderLibrary& shaders, const scene::Scene& scene, const ResolvedFrame& frame);

  /// The resolved visibility, its first channel; of the others none is for reading.
  const gl::Texture& texture() const { return targets_[newest_].texture(); }

 private:
  ResolveRule rule_;
  std::array<ImageTarget, 2> targets_;
  std::size_t newest_ = 0;
  std::optional<scene::Camera> before_;
};

}  // namespace shadowbench::render
