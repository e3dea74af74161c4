#pragma once

#include <cstdint>
#include <optional>
#include <span>

namespace shadowbench::scene {

/// What a picture's header says of its size, pixels.
struct PictureSize {
  std::uint64_t width = 0;
  std::uint64_t height = 0;
};

/// Reads the size from the header of a PNG, JPEG, BMP, GIF or TGA picture, without decoding it; nothing where the bytes
/// are no such picture. The formats must be told apart as the decoder does it, or a picture would be decoded unchecked.
std::optional<PictureSize> read_picture_size(std::span<const unsigned char> bytes);

}  // namespace shadowbench::scene
