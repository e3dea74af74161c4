#pragma once

#include <string_view>

namespace shadowbench {

/// The most names that one key may join with dots, in any TOML that is read.
inline constexpr int kMostDots = 256;

/// Finds a key of more than kMostDots dots, "a.b.c": the parser makes a table of each name, and taking those down again
/// would end the program, since it recurses. Looks at the text without parsing it, and so also counts dots inside a
/// string or comment that holds no sign which ends a key. Returns its line, or 0 where there is none.
int find_too_deep_key(std::string_view toml);

}  // namespace shadowbench
