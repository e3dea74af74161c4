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
/// are no such picture. The decoder sees the same header: what is told apart here in another way would not be checked.
std::optional<PictureSize> read_picture_size(std::span<const unsigned char> bytes);

}  // namespace shadowbench::scene
