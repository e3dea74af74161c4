#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "report/images/image.h"

namespace shadowbench::images {

/// One filter's flicker by pixel, 1 channel, 0 or more; of one size.
struct FlickerTile {
  std::string filter;
  Image free;     ///< without snapping
  Image snapped;  ///< with it
};

/// One motion's picture.
struct FlickerPicture {
  std::string title;
  std::string note;
  std::vector<FlickerTile> tiles;
};

/// Maps a flicker to the pictures' logarithmic scale: 0.001 to 0, 1 to 1. Nothing for less.
std::optional<double> place_flicker(double flicker);

/// Draws every filter's flicker without snapping and, to the right of it, with snapping, two filters in a row, all on
/// the scale of place_flicker(), as an 8-bit PNG. Requires a tile and finite values. Throws Error(kOutput).
void write_flicker_picture(const std::filesystem::path& path, const FlickerPicture& picture);

}  // namespace shadowbench::images
