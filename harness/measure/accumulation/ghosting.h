#pragma once

#include "harness/measure/accumulation/frame_drawing.h"

namespace shadowbench::measure {

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
GhostBench make_ghost_bench(const FrameBench& bench);

/// Measures how long a filter's accumulated visibility lags behind, by the exponential rules. The pixels that count are
/// those behind shadows' edges: revealed ones which the filter itself, accumulated at rest, sees within kGhostLimit of
/// the truth. `images` gets the resolved visibility when the motion of 4 texels stops, by rule.
/// Cost: a lookup for each of 40 to 104 frames of each motion, and ten maps.
std::vector<records::GhostRecord> measure_ghosts(const FrameBench& bench, const GhostBench& ghosts,
                                                 FrameDrawing& drawing, std::vector<images::Image>& images);

}  // namespace shadowbench::measure
