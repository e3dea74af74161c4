#pragma once

#include <string_view>

namespace shadowbench {

/// The most names that one key may join with dots, in any TOML that is read.
inline constexpr int kMostDots = 256;

/// Finds a key of more than kMostDots dots, "a.b.c", and returns its line, or 0. The parser makes a table of each name
/// and recurses to free them, which would end the program. Since the text is not parsed, dots in a string or comment
/// may count too.
int find_too_deep_key(std::string_view toml);

}  // namespace shadowbench
