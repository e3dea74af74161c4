#include "report/images/picture_io.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstdint>
#include <span>

#include "base/bytes.h"
#include "base/files.h"

namespace shadowbench::images {
namespace {

std::uint8_t to_code(float value) {
  return static_cast<std::uint8_t>(static_cast<double>(std::clamp(value, 0.0f, 1.0f) * 255.0f) + 0.5);
}

struct Codes {
  int channels = 0;
  std::vector<std::uint8_t> bytes;
};

bool is_finite_texel(const float* texel, int channels) {
  return std::all_of(
      texel, texel + channels, [](float value) { return std::isfinite(value); });
}

template <class Encode>
Codes encode_texels(const Image& image, int channels, Encode encode) {
  Codes codes{channels, {}};
  codes.bytes.reserve(image.texels.size() / static_cast<std::size_t>(image.channels) *
                      static_cast<std::size_t>(channels));
  for (const float* texel = image.texels.data(); texel != image.texels.data() + image.texels.size();
       texel += image.channels) {
    const bool finite = is_finite_texel(texel, image.channels);
    for (int c = 0; c < channels; ++c) {
      const float magenta = c == 1 ? 0.0f : 1.0f;
      codes.bytes.push_back(to_code(finite ? encode(texel[std::min(c, image.channels - 1)]) : magenta));
    }
  }
  return codes;
}

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

/// Rows are not filtered: most pictures here are drawn, and are then smallest so.
void write_png(const std::filesystem::path& path, const Image& image, const Codes& codes) {
  const std::size_t width = static_cast<std::size_t>(image.width * codes.channels);
  std::string rows;
  rows.reserve(codes.bytes.size() + static_cast<std::size_t>(image.height));
  for (std::size_t begin = 0; begin < codes.bytes.size(); begin += width)
    rows.append(1, '\0').append(reinterpret_cast<const char*>(codes.bytes.data()) + begin, width);
  std::string header = "IHDR";
  append_number(header, static_cast<std::size_t>(image.width));
  append_number(header, static_cast<std::size_t>(image.height));
  header.append({8, codes.channels == 3 ? '\2' : '\0', 0, 0, 0});
  std::string file = "\x89PNG\r\n\x1a\n";
  append_chunk(file, header);
  append_chunk(file, std::string("sRGB\0", 5));
  append_chunk(file, "IDAT" + compress_bytes(std::as_bytes(std::span(rows)), kPngCompression));
  append_chunk(file, "IEND");
  write_text_file(path, file);
}

}  // namespace

float encode_srgb(float linear) {
  if (!(linear > 0.0f)) return std::isnan(linear) ? linear : 0.0f;
  const float value = std::min(linear, 1.0f);
  return value <= 0.0031308f ? 12.92f * value : 1.055f * std::pow(value, 1.0f / 2.4f) - 0.055f;
}

void write_picture_png(const std::filesystem::path& path, const Image& picture) {
  assert(picture.channels == 3);
  write_png(path, picture, encode_texels(picture, 3, encode_srgb));
}

void write_display_png(const std::filesystem::path& path, const Image& picture) {
  assert(picture.channels == 3);
  write_png(path, picture, encode_texels(picture, 3, [](float value) { return value; }));
}

void write_grey_png(const std::filesystem::path& path, const Image& image) {
  assert(image.channels == 1);
  const bool finite = is_finite_texel(image.texels.data(), static_cast<int>(image.texels.size()));
  write_png(path, image, encode_texels(image, finite ? 1 : 3, [](float value) { return value; }));
}

float decode_srgb(float code) { return code <= 0.04045f ? code / 12.92f : std::pow((code + 0.055f) / 1.055f, 2.4f); }

}  // namespace shadowbench::images
