#include "report/images/picture_io.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstdint>

#include "report/images/image_file.h"
#include "report/images/stored_picture.h"

namespace shadowbench::images {
namespace {

std::uint8_t to_code(float value) {
  return static_cast<std::uint8_t>(std::lround(std::clamp(value, 0.0f, 1.0f) * 255.0f));
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

void write_png(const std::filesystem::path& path, const Image& image, const Codes& codes) {
  OIIO::ImageSpec spec(image.width, image.height, codes.channels, OIIO::TypeDesc::UINT8);
  spec.attribute("oiio:ColorSpace", "sRGB");
  write_image_file(path, [&](OIIO::ImageOutput& output, const std::string& name) {
    return output.open(name, spec) && output.write_image(OIIO::TypeDesc::UINT8, codes.bytes.data()) && output.close();
  });
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

void write_grey_png(const std::filesystem::path& path, const Image& image, GreyRange range) {
  assert(image.channels == 1 && range.black != range.white);
  const bool finite = is_finite_texel(image.texels.data(), static_cast<int>(image.texels.size()));
  const float scale = 1.0f / (range.white - range.black);
  write_png(path, image,
            encode_texels(image, finite ? 1 : 3, [&](float value) { return (value - range.black) * scale; }));
}

float decode_srgb(float code) { return code <= 0.04045f ? code / 12.92f : std::pow((code + 0.055f) / 1.055f, 2.4f); }

Image read_picture(const std::filesystem::path& path) { return read_stored_picture(path.string()).image; }

}  // namespace shadowbench::images
