#include "report/images/picture_io.h"

#include <dlfcn.h>
#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstdint>
#include <span>

#include "base/bytes.h"
#include "base/files.h"
#include "report/images/image_library.h"

namespace shadowbench::images {
namespace {

std::uint8_t to_code(float value) {
  return static_cast<std::uint8_t>(static_cast<double>(std::clamp(value, 0.0f, 1.0f) * 255.0f) + 0.5);
}

bool is_finite_texel(const float* texel, int channels) {
  return std::all_of(
      texel, texel + channels, [](float value) { return std::isfinite(value); });
}

/// Appends an image's rows as a PNG file has them: not filtered, as most pictures here are drawn, and are then
/// smallest.
template <class Encode>
void append_rows(std::string& rows, const Image& image, int channels, Encode encode) {
  const float* texel = image.texels.data();
  for (int y = 0; y < image.height; ++y) {
    rows += '\0';
    for (int x = 0; x < image.width; ++x, texel += image.channels) {
      const bool finite = is_finite_texel(texel, image.channels);
      for (int c = 0; c < channels; ++c) {
        const float magenta = c == 1 ? 0.0f : 1.0f;
        rows += static_cast<char>(to_code(finite ? encode(texel[std::min(c, image.channels - 1)]) : magenta));
      }
    }
  }
}

float keep(float value) { return value; }

constexpr int kPngCompression = 7;  // smaller than what zlib makes, in a quarter of its time

void append_number(std::string& bytes, std::size_t number) {
  for (const int shift : {24, 16, 8, 0}) bytes += static_cast<char>(number >> shift & 0xff);
}

/// Source: W3C, Portable Network Graphics, section 5.
void append_chunk(std::string& file, const std::string& name_and_data) {
  append_number(file, name_and_data.size() - 4);
  file += name_and_data;
  append_number(file, compute_crc32(std::as_bytes(std::span(name_and_data))));
}

std::string encode_png(Size size, int channels, const std::string& rows) {
  std::string header = "IHDR";
  append_number(header, static_cast<std::size_t>(size.width));
  append_number(header, static_cast<std::size_t>(size.height));
  header.append({8, channels == 3 ? '\2' : '\0', 0, 0, 0});
  std::string file = "\x89PNG\r\n\x1a\n";
  append_chunk(file, header);
  append_chunk(file, std::string("sRGB\0", 5));
  append_chunk(file, "IDAT" + compress_bytes(std::as_bytes(std::span(rows)), kPngCompression));
  append_chunk(file, "IEND");
  return file;
}

template <class Encode>
std::string encode_image(const Image& image, int channels, Encode encode) {
  std::string rows;
  rows.reserve(static_cast<std::size_t>(image.height) * static_cast<std::size_t>(image.width * channels + 1));
  append_rows(rows, image, channels, encode);
  return encode_png({image.width, image.height}, channels, rows);
}

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

float encode_srgb(float linear) {
  if (!(linear > 0.0f)) return std::isnan(linear) ? linear : 0.0f;
  const float value = std::min(linear, 1.0f);
  return value <= 0.0031308f ? 12.92f * value : 1.055f * std::pow(value, 1.0f / 2.4f) - 0.055f;
}

void write_picture_png(const std::filesystem::path& path, const Image& picture) {
  assert(picture.channels == 3);
  write_text_file(path, encode_image(picture, 3, encode_srgb));
}

void write_display_png(const std::filesystem::path& path, const Image& picture) {
  write_text_file(path, encode_display_png(picture));
}

void write_display_rows(const std::filesystem::path& path, Size size, const DrawRows& draw) {
  std::string rows;
  for (int top = 0; top < size.height;) {
    const Image band = draw(top);
    assert(band.channels == 3 && band.width == size.width && band.height > 0);
    append_rows(rows, band, 3, keep);
    top += band.height;
  }
  write_text_file(path, encode_png(size, 3, rows));
}

std::string encode_display_png(const Image& picture) {
  assert(picture.channels == 3);
  return encode_image(picture, 3, keep);
}

void write_grey_png(const std::filesystem::path& path, const Image& image) {
  assert(image.channels == 1);
  const bool finite = is_finite_texel(image.texels.data(), static_cast<int>(image.texels.size()));
  write_text_file(path, encode_image(image, finite ? 1 : 3, keep));
}

float decode_srgb(float code) { return code <= 0.04045f ? code / 12.92f : std::pow((code + 0.055f) / 1.055f, 2.4f); }

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
