#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace shadowbench {

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
