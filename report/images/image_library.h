#pragma once

#include <string>

#include "base/error.h"
#include "report/images/picture_io.h"

namespace shadowbench::images {

/// The functions that OpenImageIO does the work of. They are in a shared library of their own, opened by the first
/// call: OpenImageIO loads over two hundred others, which takes ten times as long as all else at the program's start.
/// What the two headers declare stands there, and again in the program, where it hands the call on.
struct ImageLibrary {
  decltype(&images::read_stored_picture) read_stored_picture;
  decltype(&images::read_layers) read_layers;
  decltype(&images::write_exr) write_exr;
  decltype(&images::read_exr) read_exr;
  decltype(&images::round_to_half) round_to_half;

  /// Gives the values of an image of one channel the linear colours of the map of that name; 3 channels.
  Image (*color_linearly)(const Image& values, const std::string& map);
};

/// Opens the shared library, once. Throws Error(kind) about `where` where it or OpenImageIO is not installed.
const ImageLibrary& open_image_library(ErrorKind kind, const std::string& where = {});

}  // namespace shadowbench::images

/// What the shared library has.
extern "C" [[gnu::visibility("default")]] const shadowbench::images::ImageLibrary shadowbench_image_library;
