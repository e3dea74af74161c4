#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "filters/catalogue.h"
#include "harness/measure/scene_measurement.h"
#include "harness/measure/view_receivers.h"

namespace shadowbench::measure {

/// A GPU's last-level cache, as far as reads of maps go through it.
struct CacheShape {
  std::int64_t bytes = 0;
  int line_bytes = 0;  ///< a power of two, and no less than a texel has: 16 at most
};

/// What is known of a lookup without a scalar model: its reads are counted while it is drawn.
struct PixelReads {
  int fetches[3] = {};        ///< of texels of up to 32, of 64 and of 128 bits
  double reach_texels = 0.0;  ///< from the receiver to the centre of the farthest texel, on either axis
};

/// A layer of a map with the receivers that it serves, and the reads of every pixel of the view, the lower row first.
struct CountedLayer {
  filters::DepthMap map;  ///< of which size, border, and the bytes of a narrow texel count
  std::vector<filters::Receiver> receivers;
  std::vector<PixelReads> pixels;
};

/// Counts the bytes that a filter's lookups fetch through each cache: the mean over the receivers. Nothing where the
/// filter has no scalar model, or no layer a receiver.
///
/// A line holds a block of texels of one map as near to a square as powers of two allow. Receivers are asked in tiles
/// of 8x8 pixels, row by row from the top; a tile reads each of its lines once. The cache is empty at first, associates
/// fully, and drops the line that was not read for the longest time. Reads outside a map, and what the passes before
/// the lookup read and write, are not counted.
/// Cost: the model's prefilter in single precision, and some of its lookups: a tile's receivers are asked in an order
/// that spreads them over it, until 8 in a row, with 128 reads, bring no new line.
std::optional<std::vector<double>> count_map_traffic(const filters::FilterRequest& request,
                                                     const std::vector<ModelLayer>& layers, const ModelView& view,
                                                     std::span<const CacheShape> caches);

/// The same of lookups whose reads were counted: they are taken to lie evenly in the square that they reach, each in
/// the middle of four texels, in maps of the depth map's size, one for each width of texels.
std::optional<std::vector<double>> count_map_traffic(const std::vector<CountedLayer>& layers, const ModelView& view,
                                                     std::span<const CacheShape> caches);

/// Counts what the lookups of a task's cells bring from memory into the last caches of the run's GPUs. It draws the
/// view's receivers anew, those of a frame of 1080 rows, whatever the size of the run's pictures: receivers of a small
/// picture share fewer lines of the map, and would count more for each. Where every second of them in each direction
/// still lies about a texel from the next, only these are asked.
class TrafficMeter {
 public:
  /// `texels_per_pixel` is that of the run's pictures. Draws the view, and reads the map back.
  TrafficMeter(const TaskRig& rig, std::optional<double> texels_per_pixel);

  /// Notes the bytes of one receiver's lookup, one number for each GPU; leaves the cell as it is where another process
  /// drew it, where the filter reads the map's samplers itself, or the view has no receiver. What a filter without a
  /// scalar model reads is counted: it is drawn again. Cost: a readback of the receivers, and count_map_traffic().
  void measure(MeasuredCell& cell);

 private:
  TaskRig rig_;
  const LightMap& light_;
  int step_;  ///< every how many rows and columns of the frame are asked
  render::GBuffer gbuffer_;
  std::vector<CacheShape> caches_;
  std::vector<ModelLayer> layers_;

  std::vector<CountedLayer> count_reads(const MeasuredCell& cell);
};

}  // namespace shadowbench::measure
