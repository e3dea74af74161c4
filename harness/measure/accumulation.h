#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "harness/measure/scene_assets.h"
#include "harness/measure/scene_measurement.h"
#include "harness/render/picture_passes.h"
#include "report/images/heat_figures.h"

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
  FrameDrawing(const TaskRig& rig, const filters::FilterRequest& request);

  /// Draws a frame, and adds it to what is accumulated. Cost: prefilter and lookup, and a pass for each of `resolves`.
  void draw(const ShownFrame& frame, std::vector<render::ResolvePass>& resolves);

  /// The plain mean of `count` frames from a number on.
  images::Image average(ShownFrame frame, int count);

 private:
  TaskRig rig_;
  std::unique_ptr<render::FilterPasses> filter_;
  render::ImageTarget target_;
};

/// Passes that begin to accumulate by each of the rules from `first` on.
std::vector<render::ResolvePass> make_resolves(const TaskRig& rig, std::size_t first = 0);

/// Texels a frame of the motion whose pictures are kept.
inline constexpr double kShownTexels = 4.0;

/// A turn of a task's light about the vertical, frame by frame.
struct GhostMotion {
  double texels = 0.0;                 ///< a frame, at the median shadow
  std::vector<scene::Light> lights;    ///< of the frames, the first at rest
  SceneTruth end;                      ///< of the last light
  std::vector<std::uint8_t> revealed;  ///< 1 where the truth is dark before the motion and lit after it
};

/// What ghosting is measured with, the same for all filters: shadows that move by 1, 4 and 16 texels a frame.
struct GhostBench {
  std::vector<GhostMotion> motions;
  std::string absent;  ///< why there are none; empty where there are
};

/// Makes it. Nothing moves where the light stands overhead, where the map has several layers, or in a view without
/// shadows. Cost: three truths.
GhostBench make_ghost_bench(const TaskRig& rig);

/// Measures how long a filter's accumulated visibility lags behind, by the exponential rules. The pixels that count are
/// those behind shadows' edges: revealed ones which the filter itself, accumulated at rest, sees within kGhostLimit of
/// the truth. `images` gets the resolved visibility when the motion of 4 texels stops, by rule.
/// Cost: a lookup for each of 40 to 104 frames of each motion, and ten maps.
std::vector<records::GhostRecord> measure_ghosts(const TaskRig& rig, const GhostBench& ghosts, FrameDrawing& drawing,
                                                 std::vector<images::Image>& images);

/// What a filter drew while it was accumulated, by rule.
struct AccumulatedImages {
  std::vector<images::Image> resolved;  ///< after the last frame, with jitter
  std::vector<images::Image> stopped;   ///< by the exponential rules, when shadows stop that moved by 4 texels a frame
};

/// Measures what accumulation over `options.frames` frames makes of the filters of a task.
class AccumulationMeter {
 public:
  /// Requires a truth.
  explicit AccumulationMeter(const TaskRig& rig);

  /// Gives nothing where the filter is finite at no receiver.
  /// Cost: prefilter and lookup twice a frame; 256 more where the filter is stochastic; and those of measure_ghosts().
  std::optional<records::AccumulationRecord> measure(const filters::FilterRequest& request, AccumulatedImages& images);

  /// Shows them, as errors and as visibility.
  std::vector<images::ErrorTile> show(const std::string& label, const AccumulatedImages& images) const;

 private:
  TaskRig rig_;
  render::GBuffer jittered_;
  const SceneTruth& truth_;
  images::Image jittered_truth_;  ///< the mean over all places of the camera
  GhostBench ghosts_;
  std::vector<double> resolve_ms_;  ///< of each exponential rule

  struct Sequence;
  std::vector<records::ResolveRecord> follow(FrameDrawing& drawing, const Sequence& sequence,
                                             std::vector<images::Image>& last);
  ShownFrame show_frame(int number, bool jitter);
  void trace_jittered();
  void time_resolves();
};

}  // namespace shadowbench::measure
