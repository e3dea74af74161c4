#pragma once

#include <filesystem>
#include <map>
#include <string>

#include "harness/gl/recorder/recorder.h"

namespace shadowbench::live {

/// Writes frames that were recorded, so that a page can draw them with WebGL 2: `live/<name>.js` in a report's folder,
/// beside a file of its own for each buffer and texture with contents. Files are named for what they hold.
///
/// The script calls `shadowbenchFrames(name, text)`; the text is base64 of a zlib stream of JSON:
///
/// | Member | Is |
/// |---|---|
/// | `textures` | format, width, height, levels, samples |
/// | `programs` | label; vertex and fragment, GLSL of WebGL 2; or refused, why there is none |
/// | `blobs` | files of `shadowbenchBlob(name, text)`, whose text is packed in the same way; `rows` and `columns` of
/// 32-bit
///   words, which a page reads as it does planes of floats; or bytes as they are |
/// | `steps` | in an order in which they can be drawn: `draw`, `clear`, `upload`, `mipmaps`, as in gl::Step; a step is
///   named by its place in this list |
/// | `cells` | the step that draws the picture, by the cell's key |
///
/// Steps that are alike are one step: what cells share is drawn once. GL's enumerations are its numbers, which WebGL
/// shares.
/// Returns the script's path in the folder. Throws Error(kOutput).
std::string write_frames(const std::filesystem::path& folder, const std::map<std::string, gl::StepPointer>& pictures);

/// Copies what write_frames() wrote into a folder to another one, which may have some of it.
/// Throws Error(kOutput).
void copy_frames(const std::filesystem::path& from, const std::filesystem::path& to);

}  // namespace shadowbench::live
