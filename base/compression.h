#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

namespace shadowbench {

/// Packs bytes as a zlib stream. Levels go from 1, fast, to 12, small.
/// Source: RFC 1950.
std::string compress_bytes(std::span<const std::byte> bytes, int level);

/// Unpacks a zlib stream; returns whether it was whole and held exactly as many bytes as `bytes` has room for.
bool decompress_bytes(std::span<const std::byte> packed, std::span<std::byte> bytes);

/// The most bytes that a packed stream of so many can have.
std::size_t bound_compressed(std::size_t bytes);

/// The checksum that PNG files have.
std::uint32_t compute_crc32(std::span<const std::byte> bytes);

}  // namespace shadowbench
