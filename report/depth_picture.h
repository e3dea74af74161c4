#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "report/image.h"

namespace shadowbench::report {

/// A depth map to be looked at.
struct DepthPicture {
  std::string title;
  std::string note;
  Image depth;                ///< one channel, [0,1], 0 near, row 0 on top; 1: nothing was drawn
  double range_m = 0.0;       ///< metres from depth 0 to depth 1, where depth is linear
};

/// How often depths occur.
struct DepthHistogram {
  std::vector<std::int64_t> counts;  ///< of texels, in equal bins over [0,1]
  std::int64_t empty = 0;            ///< texels of depth 1, in no bin
};

/// Counts depths. Requires one channel and at least one bin; depths outside [0,1] go to the nearest bin.
DepthHistogram count_depths(const Image& depth, int bins);

/// Draws a linear depth map, stretched over the depths that occur, with its histogram below: texels per bin on a
/// logarithmic axis, over depth and over metres. Display values.
/// Throws Error(kOutput) where the font is not installed.
Image draw_depth_picture(const DepthPicture& picture);

/// Writes it as PNG. Throws Error(kOutput).
void write_depth_picture(const std::filesystem::path& path, const DepthPicture& picture);

}  // namespace shadowbench::report
