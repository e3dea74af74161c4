#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "filters/depth_curve.h"
#include "report/images/image.h"

namespace shadowbench::images {

/// A layer of a depth map: all of it, a cascade, or a face of a cube.
struct DepthLayer {
  Image stored;          ///< one channel, [0,1], row 0 on top; the curve's far plane: nothing was drawn
  double range_m = 0.0;  ///< metres from depth 0 to depth 1
  std::string name = {};
};

/// A depth map to be looked at.
struct DepthPicture {
  std::string title;
  std::string note;
  std::vector<DepthLayer> layers;
  filters::DepthCurve curve;  ///< says what depth a stored value stands for
};

/// How often depths occur.
struct DepthHistogram {
  std::vector<std::int64_t> counts;  ///< of texels, in equal bins over [0,1]
  std::int64_t empty = 0;            ///< texels that hold `far_plane`, in no bin
};

/// Counts depths. Requires one channel and at least one bin; depths outside [0,1] go to the nearest bin.
DepthHistogram count_depths(const Image& depth, int bins, float far_plane = 1.0f);

/// Draws a depth map as it is stored and, where that is not linear depth, linearised beside it: each stretched over the
/// values that occur, with its histogram below, texels per bin on a logarithmic axis over value and metres. Several
/// layers stand side by side, smaller, and what is linearised below what is stored. Display values. Throws
/// Error(kOutput) where the font is not installed.
Image draw_depth_picture(const DepthPicture& picture);

/// Writes it as PNG. Throws Error(kOutput).
void write_depth_picture(const std::filesystem::path& path, const DepthPicture& picture);

}  // namespace shadowbench::images
