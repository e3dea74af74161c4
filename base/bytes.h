#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

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

/// Names content: equal bytes in equal order give equal names, on every machine of one byte order.
///
/// 128 bits of XXH64 with two seeds: against accidents, not against attackers.
class ContentHash {
 public:
  void add(std::span<const std::byte> bytes);
  void add(std::string_view text);

  template <class T>
  void add_values(std::span<const T> values) {
    add(std::as_bytes(values));
  }

  /// 32 hexadecimal digits.
  std::string name() const;

 private:
  std::uint64_t low_ = 0;
  std::uint64_t high_ = 1;
};

}  // namespace shadowbench
