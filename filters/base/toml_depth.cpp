#include "filters/base/toml_depth.h"

namespace shadowbench {

int find_too_deep_key(std::string_view toml) {
  constexpr std::string_view kEndsAKey = "=,[]{}#\n";
  int line = 1;
  int dots = 0;
  for (const char c : toml) {
    if (c == '\n') ++line;
    if (kEndsAKey.find(c) != std::string_view::npos) dots = 0;
    if (c == '.' && ++dots > kMostDots) return line;
  }
  return 0;
}

}  // namespace shadowbench
