#include "report/images/image_library.h"

#include <dlfcn.h>
#include <fmt/format.h>

namespace shadowbench::images {
namespace {

const ImageLibrary& load_library(ErrorKind kind, const std::string& where) {
  void* file = dlopen("shadowbench_openimageio.so", RTLD_NOW);
  if (const void* library = file != nullptr ? dlsym(file, "shadowbench_image_library") : nullptr)
    return *static_cast<const ImageLibrary*>(library);
  throw Error(
      kind,
      fmt::format("images are read and written by OpenImageIO, which cannot be loaded ({}); install the package "
                  "libopenimageio-dev, or Shadowbench again",
                  dlerror()),
      where);
}

}  // namespace

const ImageLibrary& open_image_library(ErrorKind kind, const std::string& where) {
  static const ImageLibrary& library = load_library(kind, where);
  return library;
}

StoredPicture read_stored_picture(const std::string& name) {
  return open_image_library(ErrorKind::kInput, name).read_stored_picture(name);
}

std::map<std::string, StoredPicture> read_layers(const std::string& file) {
  return open_image_library(ErrorKind::kInput, file).read_layers(file);
}

void write_exr(const std::filesystem::path& path, const std::vector<Part>& parts, const Metadata& metadata) {
  open_image_library(ErrorKind::kOutput, path.string()).write_exr(path, parts, metadata);
}

ExrFile read_exr(const std::filesystem::path& path, const PartChoice& is_wanted) {
  return open_image_library(ErrorKind::kInput, path.string()).read_exr(path, is_wanted);
}

Image round_to_half(const Image& image) { return open_image_library(ErrorKind::kOutput).round_to_half(image); }

Image read_picture(const std::filesystem::path& path) { return read_stored_picture(path.string()).image; }

}  // namespace shadowbench::images
