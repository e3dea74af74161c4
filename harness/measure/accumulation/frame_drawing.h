#pragma once

#include <memory>
#include <string>
#include <vector>

#include "harness/measure/filter_setup.h"
#include "harness/measure/scene_measurement.h"
#include "harness/render/picture_passes.h"

namespace shadowbench::measure {

/// Places within a pixel that the camera takes in turn.
inline constexpr int kJitters = 8;

/// Where the camera's pixels lie in a frame, in pixels from where they lie without jitter, in (-1/2, 1/2) along each
/// axis. Source: Karis 2014, High-Quality Temporal Supersampling, SIGGRAPH: eight points of Halton's sequence (1960, On
/// the Efficiency of Certain Quasi-Random Sequences of Points, Numerische Mathematik 2) with the bases 2 and 3.
glm::dvec2 find_jitter(int frame);

/// A way to accumulate, by the name that records have.
struct NamedRule {
  std::string name;
  render::ResolveRule rule;
};

/// Lists them: the newest frame alone, the plain mean, and the exponential one without clamping and with it.
const std::vector<NamedRule>& list_resolve_rules();
inline constexpr std::size_t kFirstExponential = 2;  ///< the others come before

/// What one task is drawn with, frame by frame.
struct FrameBench {
  Renderer& renderer;
  const options::RunOptions& options;
  const SceneTask& task;
  SceneAssets& assets;
};

/// What a frame shows.
struct ShownFrame {
  std::uint32_t number = 0;  ///< turns the taps
  const scene::Light& light;
  const LightMap& map;  ///< of this light
  const render::GBuffer& gbuffer;
};

/// One filter that is drawn frame by frame.
class FrameDrawing {
 public:
  /// Everything must outlive this object.
  FrameDrawing(const FrameBench& bench, const filters::FilterRequest& request);

  /// Draws a frame, and adds it to what is accumulated. Cost: prefilter and lookup, and a pass for each of `resolves`.
  void draw(const ShownFrame& frame, std::vector<render::ResolvePass>& resolves);

  /// The plain mean of `count` frames from a number on.
  images::Image average(ShownFrame frame, int count);

 private:
  FrameBench bench_;
  std::unique_ptr<render::FilterPasses> filter_;
  render::ImageTarget target_;
};

/// Passes that begin to accumulate by each of the rules from `first` on.
std::vector<render::ResolvePass> make_resolves(const FrameBench& bench, std::size_t first = 0);

}  // namespace shadowbench::measure
