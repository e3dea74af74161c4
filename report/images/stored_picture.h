#pragma once

#include <map>
#include <string>
#include <vector>

#include "report/images/image.h"

namespace shadowbench::images {

/// One picture as its file stores it.
struct StoredPicture {
  Image image;             ///< integer codes as code / largest code; colours are not multiplied by alpha on the way
  int alpha_channel = -1;  ///< -1: there is none
  std::vector<std::string> channel_names = {};  ///< "R", "lit.R"
  bool srgb = false;  ///< integer codes that OpenImageIO calls sRGB; anything else is taken for linear
  int origin_x = 0;   ///< where the data window begins
  int origin_y = 0;
};

/// Reads a picture that `name` names: FILE, or FILE#PART for one part of a file with several, or for one layer of a
/// part (channels such as PART.R). A file of the whole name comes first, and FILE alone is its first part. A part
/// without a name of its own goes by its number, from 0. Throws Error(kInput): no such file, unreadable, damaged, no
/// such part (naming those there are), deep or volumetric. Cost: reads that part alone.
StoredPicture read_stored_picture(const std::string& name);

/// Reads all of a file's pictures by their layers' names: what stands before the last dot of its channels' names, or
/// else the part's name, empty where it has none. Throws likewise. Cost: reads the whole file.
std::map<std::string, StoredPicture> read_layers(const std::string& file);

}  // namespace shadowbench::images
