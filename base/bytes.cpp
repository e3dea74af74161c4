#include "base/bytes.h"

#include <fmt/format.h>
#include <libdeflate.h>
#include <xxhash.h>

#include <memory>
#include <new>

namespace shadowbench {
namespace {

template <class T, void (*release)(T*)>
struct Release {
  void operator()(T* object) const { release(object); }
};
using Compressor = std::unique_ptr<libdeflate_compressor, Release<libdeflate_compressor, libdeflate_free_compressor>>;
using Decompressor =
    std::unique_ptr<libdeflate_decompressor, Release<libdeflate_decompressor, libdeflate_free_decompressor>>;

}  // namespace

std::string compress_bytes(std::span<const std::byte> bytes, int level) {
  const Compressor compressor(libdeflate_alloc_compressor(level));
  if (!compressor) throw std::bad_alloc();
  std::string packed(libdeflate_zlib_compress_bound(compressor.get(), bytes.size()), '\0');
  packed.resize(libdeflate_zlib_compress(compressor.get(), bytes.data(), bytes.size(), packed.data(), packed.size()));
  return packed;
}

bool decompress_bytes(std::span<const std::byte> packed, std::span<std::byte> bytes) {
  const Decompressor decompressor(libdeflate_alloc_decompressor());
  if (!decompressor) throw std::bad_alloc();
  return libdeflate_zlib_decompress(decompressor.get(), packed.data(), packed.size(), bytes.data(), bytes.size(),
                                    nullptr) == LIBDEFLATE_SUCCESS;
}

std::size_t bound_compressed(std::size_t bytes) { return libdeflate_zlib_compress_bound(nullptr, bytes); }

std::uint32_t compute_crc32(std::span<const std::byte> bytes) {
  return libdeflate_crc32(0, bytes.data(), bytes.size());
}

void ContentHash::add(std::span<const std::byte> bytes) {
  // The length goes in too, so that pieces cannot slide into each other.
  low_ = XXH64(bytes.data(), bytes.size(), low_ + bytes.size());
  high_ = XXH64(bytes.data(), bytes.size(), ~high_ - bytes.size());
}

void ContentHash::add(std::string_view text) { add(std::as_bytes(std::span(text))); }

std::string ContentHash::name() const { return fmt::format("{:016x}{:016x}", high_, low_); }

}  // namespace shadowbench
