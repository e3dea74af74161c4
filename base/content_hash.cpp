#include "base/content_hash.h"

#include <fmt/format.h>
#include <xxhash.h>

namespace shadowbench {

void ContentHash::add(std::span<const std::byte> bytes) {
  // The length goes in too, so that pieces cannot slide into each other.
  low_ = XXH64(bytes.data(), bytes.size(), low_ + bytes.size());
  high_ = XXH64(bytes.data(), bytes.size(), ~high_ - bytes.size());
}

void ContentHash::add(std::string_view text) { add(std::as_bytes(std::span(text))); }

std::string ContentHash::name() const { return fmt::format("{:016x}{:016x}", high_, low_); }

}  // namespace shadowbench
