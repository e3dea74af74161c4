#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "filters/depth_map.h"
#include "report/images/figure.h"

namespace shadowbench::images {

/// A layer of a depth map: all of it, a cascade, or a face of a cube.
struct DepthLayer {
  Image stored;          ///< one channel, [0,1], row 0 on top; the curve's far plane: nothing was drawn
  double range_m = 0.0;  ///< metres from depth 0 to depth 1
  std::string name = {};
};

/// How often depths occur.
struct DepthHistogram {
  std::vector<std::int64_t> counts;  ///< of texels, in equal bins over [0,1]
  std::int64_t empty = 0;            ///< texels that hold `far_plane`, in no bin
};

/// Counts depths. Requires one channel and at least one bin; depths outside [0,1] go to the nearest bin.
DepthHistogram count_depths(const Image& depth, int bins, float far_plane = 1.0f);

/// Shows every layer of a depth map as it is stored and, where that is not linear depth, after them each linearised:
/// stretched over the values that occur, with its histogram below, texels per bin on a logarithmic axis over value and
/// metres. One of several layers is smaller than the only one.
std::vector<Stack> show_depth(const std::vector<DepthLayer>& layers, const filters::DepthCurve& curve);

/// Shows texels per pixel as colours on a logarithmic scale, 1/64 to 64, with a colour bar. `density`: one channel; 0:
/// turned away from the light or outside the map, -1: background.
Stack show_density(const Image& density);

/// Chooses how many texels a side of a chessboard's field has: the smallest power of two, 1 or more, for which the
/// median field of a receiver covers 36 pixels; 1 where no receiver faces the light.
int choose_field_texels(const Image& density);

/// Shows the map's texels on the surfaces as a chessboard whose dark fields darken the picture, each of
/// choose_field_texels() a side, which the words say. Where fields are smaller than 4 pixels the pattern fades, and it
/// is gone where they are smaller than 2: it would show the pixels' grid instead.
/// `picture`: linear RGB; `texel`: place in the map in texels, two channels; `density`: as show_density().
Stack show_texels(const Image& picture, const Image& texel, const Image& density);

}  // namespace shadowbench::images
