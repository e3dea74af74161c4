#pragma once

#include <string>

namespace shadowbench::filters {

/// A filter's GLSL in which loops count.
struct CountedLoops {
  std::string body;  ///< with as many lines as before
  int loops = 0;
};

/// Wraps the condition of every `for` and `while` as `count_turn(INDEX, condition)`, of lib/map_access.glsl. A
/// condition that declares something is left as it is, and so is what does not look like a loop.
CountedLoops count_loops(const std::string& glsl);

}  // namespace shadowbench::filters
