#include "harness/scene/files/picture_header.h"

#include <algorithm>
#include <array>
#include <initializer_list>

namespace shadowbench::scene {
namespace {

using Bytes = std::span<const unsigned char>;

constexpr std::uint64_t from_big_endian(Bytes bytes) {
  std::uint64_t value = 0;
  for (const unsigned char byte : bytes) value = value << 8 | byte;
  return value;
}

constexpr std::uint64_t from_little_endian(Bytes bytes) {
  std::uint64_t value = 0;
  for (std::size_t i = bytes.size(); i > 0; --i) value = value << 8 | bytes[i - 1];
  return value;
}

bool starts_with(Bytes bytes, std::initializer_list<unsigned char> signature) {
  return bytes.size() >= signature.size() && std::equal(signature.begin(), signature.end(), bytes.begin());
}

std::optional<PictureSize> png_size(Bytes bytes) {
  constexpr std::array<unsigned char, 4> kHeader{'I', 'H', 'D', 'R'};
  if (bytes.size() < 24 || !std::ranges::equal(bytes.subspan(12, 4), kHeader)) return std::nullopt;
  return PictureSize{from_big_endian(bytes.subspan(16, 4)), from_big_endian(bytes.subspan(20, 4))};
}

/// The magnitude of a signed height: negative ones say that the rows run from the top.
std::uint64_t magnitude(std::uint64_t bits) { return bits > 0x7fffffffU ? 0x100000000U - bits : bits; }

std::optional<PictureSize> bmp_size(Bytes bytes) {
  if (bytes.size() < 26) return std::nullopt;
  if (from_little_endian(bytes.subspan(14, 4)) == 12)
    return PictureSize{from_little_endian(bytes.subspan(18, 2)), from_little_endian(bytes.subspan(20, 2))};
  return PictureSize{magnitude(from_little_endian(bytes.subspan(18, 4))),
                     magnitude(from_little_endian(bytes.subspan(22, 4)))};
}

std::optional<PictureSize> gif_size(Bytes bytes) {
  if (bytes.size() < 10) return std::nullopt;
  return PictureSize{from_little_endian(bytes.subspan(6, 2)), from_little_endian(bytes.subspan(8, 2))};
}

/// A TGA has no signature: its second and third byte say whether it has a palette, and how its pixels are packed.
std::optional<PictureSize> tga_size(Bytes bytes) {
  constexpr std::array<unsigned char, 6> kKinds{1, 2, 3, 9, 10, 11};
  if (bytes.size() < 18 || bytes[1] > 1 || std::ranges::find(kKinds, bytes[2]) == kKinds.end()) return std::nullopt;
  return PictureSize{from_little_endian(bytes.subspan(12, 2)), from_little_endian(bytes.subspan(14, 2))};
}

/// Goes from marker to marker to the first that begins a frame.
std::optional<PictureSize> jpeg_size(Bytes bytes) {
  std::size_t at = 2;
  while (at + 8 < bytes.size()) {
    if (bytes[at] != 0xff || bytes[at + 1] == 0xff) {
      ++at;
      continue;
    }
    const unsigned char marker = bytes[at + 1];
    if (marker >= 0xc0 && marker <= 0xc2)
      return PictureSize{from_big_endian(bytes.subspan(at + 7, 2)), from_big_endian(bytes.subspan(at + 5, 2))};
    at += 2 + from_big_endian(bytes.subspan(at + 2, 2));
  }
  return std::nullopt;
}

}  // namespace

std::optional<PictureSize> read_picture_size(std::span<const unsigned char> bytes) {
  if (starts_with(bytes, {0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'})) return png_size(bytes);
  if (starts_with(bytes, {0xff, 0xd8})) return jpeg_size(bytes);
  if (starts_with(bytes, {'B', 'M'})) return bmp_size(bytes);
  if (starts_with(bytes, {'G', 'I', 'F', '8'})) return gif_size(bytes);
  return tga_size(bytes);
}

}  // namespace shadowbench::scene
