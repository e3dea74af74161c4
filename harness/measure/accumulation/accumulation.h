#pragma once

#include <optional>

#include "harness/measure/accumulation/ghosting.h"
#include "report/images/grid.h"

namespace shadowbench::measure {

/// What a filter drew while it was accumulated, by rule.
struct AccumulatedImages {
  std::vector<images::Image> resolved;  ///< after the last frame, with jitter
  std::vector<images::Image> stopped;   ///< by the exponential rules, when shadows stop that moved by 4 texels a frame
};

/// Measures what accumulation over `options.frames` frames makes of the filters of a task.
class AccumulationMeter {
 public:
  /// Everything must outlive this object. Requires a truth.
  explicit AccumulationMeter(const FrameBench& bench);

  /// Gives nothing where the filter is finite at no receiver.
  /// Cost: prefilter and lookup twice a frame; 256 more where the filter is stochastic; and those of measure_ghosts().
  std::optional<records::AccumulationRecord> measure(const filters::FilterRequest& request, AccumulatedImages& images);

  /// Shows them, as errors and as visibility.
  std::vector<images::GridTile> show(const std::string& label, const AccumulatedImages& images) const;

 private:
  FrameBench bench_;
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
