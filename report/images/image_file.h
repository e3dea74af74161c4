#pragma once

#include <OpenImageIO/imageio.h>

#include <filesystem>
#include <functional>
#include <string>

namespace shadowbench::images {

/// Opens a file by the name it is given, writes it and closes it; gives whether that went well.
using ImageWriting = std::function<bool(OIIO::ImageOutput& output, const std::string& name)>;

/// Has OpenImageIO write an image file, which appears whole or not at all: the image libraries do not check
/// whether what they write arrives on the disk, so this function writes their bytes and checks. Throws Error(kOutput).
void write_image_file(const std::filesystem::path& path, const ImageWriting& write);

}  // namespace shadowbench::images
