#pragma once

#include <filesystem>
#include <string>

#include "report/images/image.h"

namespace shadowbench::images {

/// How two pictures differ, for people.
struct DifferencePicture {
  std::string title;  ///< "a.exr less b.exr"
  std::string note;   ///< the numbers
  Image difference;   ///< 1 channel, signed; NaN where a picture is not finite, infinite where a pixel does not count
  Image flip;         ///< 1 channel, [0,1]; empty where there is none
  std::string no_flip = {};  ///< why
};

/// Draws the signed difference and the FLIP map, each with its scale, into an 8-bit PNG file.
/// Throws Error(kOutput).
void write_difference_picture(const std::filesystem::path& path, const DifferencePicture& picture);

}  // namespace shadowbench::images
