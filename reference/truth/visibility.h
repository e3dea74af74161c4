#pragma once

#include <cstdint>
#include <vector>

#include "reference/truth/area_light.h"
#include "reference/truth/occluders.h"

namespace shadowbench::reference {

/// A receiver point of the G-buffer.
struct ReceiverPoint {
  glm::vec3 position_ws{0.0f};
  glm::vec3 normal_ws{0.0f, 1.0f, 0.0f};  ///< geometric, unit length, flipped to the viewer
  bool counts = false;                    ///< false: background, or turned away from the light; not traced
};

/// Receivers as an image, row by row.
struct ReceiverImage {
  int width = 0;
  int height = 0;
  std::vector<ReceiverPoint> points;  ///< width * height
};

/// Says how sure the area truth is to be.
struct AreaSettings {
  double standard_error = 0.005;  ///< wanted for every pixel that is not unanimous
  int max_points = 1024;          ///< per scramble; a power of two, at least 16
  std::uint32_t seed = 1;
};

/// The number of independent scrambles; the standard error has one degree of freedom less.
inline constexpr int kScrambles = 16;

/// The visibility of a light at every receiver; 1 lit, 0 blocked, 1 where a point does not count.
struct AreaTruth {
  std::vector<float> visibility;
  std::vector<float> standard_error;      ///< over the scrambles; where all rays agree there is none: 0, see `unanimous`
  std::vector<std::uint8_t> unanimous;    ///< all rays of this pixel agree; the truth lies within 3 / rays of them (95 %)
  std::vector<std::uint32_t> rays;        ///< traced for this pixel
};

/// Traces the fraction of an area light that each receiver sees.
///
/// Sixteen Owen-scrambled Sobol sets of 4 points each; a pixel stops there when it and its eight neighbours are
/// unanimous, the others go on with 16 points and double them until the standard error over the scrambles is small enough
/// or `max_points` is reached. The part of the light below a receiver's own plane is blocked by it. The result depends on
/// neither the number of threads nor the order of pixels.
/// Cost: 64 rays for a pixel away from edges, up to 16 * max_points at one.
AreaTruth trace_area(const Occluders& occluders, const ReceiverImage& receivers, const AreaLight& light,
                     const AreaSettings& settings);

/// Traces one ray from each receiver to the light's centre: 1 seen, 0 blocked, 1 where a point does not count.
std::vector<float> trace_hard(const Occluders& occluders, const ReceiverImage& receivers, const AreaLight& light);

}  // namespace shadowbench::reference
