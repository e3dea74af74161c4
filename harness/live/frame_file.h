#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "filters/catalogue.h"
#include "harness/gl/recorder.h"
#include "report/images/image.h"

namespace shadowbench::live {

/// How a cell was drawn.
struct Frame {
  gl::StepPointer picture;
  gl::StepPointer empty = nullptr;  ///< a lookup that reads what the filter's does, but nothing of the map
  filters::FilterRequest request = {};
  double light_size = 0.0;  ///< its diameter seen from the scene, of a sun the doubled tangent of half the angle
};

/// Texels that the run drew, for a page to take in place of its own.
struct KnownTexels {
  gl::RecordedContent content;
  images::Rect rect;  ///< of the texture, rows from below
  int channels = 1;
  float fill = 0.0f;          ///< what stands in all texels around
  std::vector<float> texels;  ///< of the rectangle
};

/// Where the page's drawing can be held against the run's, texel by texel.
struct Check {
  images::Rect rect;  ///< of the picture, rows from above
  std::vector<KnownTexels> known;
  bool is_whole = false;  ///< all of receivers and maps is known, since vertices are too many to be drawn from
};

// clang-format off
/// Writes frames that were recorded, so that a page can draw them with WebGL 2: a script in the folder `live` of a
/// report, and one for each buffer and texture with contents. Files are named for what they hold.
///
/// A script calls `shadowbenchValues(path, text)`; the text is base64 of a zlib stream, here of JSON:
///
/// | Member | Is |
/// |---|---|
/// | `textures` | format, width, height, levels, samples |
/// | `programs` | label; vertex and fragment, GLSL of WebGL 2; or refused, why there is none |
/// | `blobs` | path of the script; `rows` and `columns` of 32-bit words, which a page reads as planes of floats are read, or 0 for plain bytes |
/// | `steps` | `draw`, `clear`, `upload`, `mipmaps`, as gl::Step has them; a step is named by its place in this list, and comes after what it needs |
/// | `check` | the part of the picture that it is for, the known texels, with the step that draws them, and whether they are all |
/// | `cells` | by the cell's key: the steps of its picture and its empty lookup, and its parameters with their limits |
///
/// Steps that are alike are one step: what cells share is drawn once. GL's enumerations are its numbers, which WebGL
/// shares. Returns the script's path in the folder. Throws Error(kOutput).
// clang-format on
std::string write_frames(const std::filesystem::path& folder, const std::map<std::string, Frame>& frames,
                         const Check& check);

/// Copies what write_frames() wrote into a folder to another one, which may have some of it.
/// Throws Error(kOutput).
void copy_frames(const std::filesystem::path& from, const std::filesystem::path& to);

}  // namespace shadowbench::live
