#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <variant>
#include <vector>

#include "report/images/image.h"

namespace shadowbench::images {

/// Encodes one linear value in [0,1] for a display; values outside are clamped, NaN stays NaN.
/// Source: IEC 61966-2-1 (sRGB).
float encode_srgb(float linear);

/// Decodes one sRGB value in [0,1] to linear; the inverse of encode_srgb().
/// Source: IEC 61966-2-1 (sRGB).
float decode_srgb(float code);

/// Writes a linear RGB picture as an 8-bit sRGB PNG.
/// Requires 3 channels. Values outside [0,1] are clamped; a texel that is not finite becomes magenta.
/// Throws Error(kOutput).
void write_picture_png(const std::filesystem::path& path, const Image& picture);

/// Writes a picture that is display-referred already: sRGB values in [0,1] become 8-bit codes.
/// Requires 3 channels. Throws Error(kOutput).
void write_display_png(const std::filesystem::path& path, const Image& picture);

/// The bytes of that file.
std::string encode_display_png(const Image& picture);

/// Draws some rows of a picture, from `top` on.
using DrawRows = std::function<Image(int top)>;

/// Writes such a picture as it is drawn, so that all of it is never in memory. Throws Error(kOutput).
void write_display_rows(const std::filesystem::path& path, Size size, const DrawRows& draw);

/// Writes one channel as an 8-bit grey PNG whose codes are linear in the value: visibility .5 becomes code 128 of 255.
/// Requires 1 channel. Values outside [0,1] are clamped; a texel that is not finite becomes
/// magenta, and the PNG then has three channels. Throws Error(kOutput).
void write_grey_png(const std::filesystem::path& path, const Image& image);

/// Reads the first image of any file OpenImageIO knows, its values as stored (8-bit codes as code/255).
/// Throws Error(kInput).
Image read_picture(const std::filesystem::path& path);

/// One named image of a multi-part EXR file.
struct Part {
  std::string name;                        ///< "vsm.visibility"; unique in its file
  std::vector<std::string> channel_names;  ///< one per channel of `image`: R, G, B, or others in alphabetical order
  Image image;
  bool half = false;  ///< stored as 16-bit floats
};

/// A file's attributes, by name.
using Metadata = std::map<std::string, std::variant<double, std::string>>;

/// Rounds a picture to 16-bit floats, as a half part keeps it. Values above 65504 become infinite.
Image round_to_half(const Image& image);

/// Writes a multi-part OpenEXR file, losslessly compressed; parts may differ in size. Metadata go into every part.
/// Requires at least one part. Throws Error(kOutput), also where names are not unique.
void write_exr(const std::filesystem::path& path, const std::vector<Part>& parts, const Metadata& metadata);

/// A multi-part EXR file.
struct ExrFile {
  std::vector<Part> parts;
  Metadata metadata;  ///< of the first part: numbers and texts, the format's own attributes included
};

/// Chooses parts of a file by their names.
using PartChoice = std::function<bool(const std::string& name)>;

/// Reads a multi-part EXR file, or the parts of it that are wanted. Throws Error(kInput).
ExrFile read_exr(
    const std::filesystem::path& path, const PartChoice& is_wanted = [](const std::string&) { return true; });

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
