#pragma once

#include <cstdint>
#include <vector>

#include "reference/truth/occluders.h"

struct RTCFilterFunctionNArguments;

namespace shadowbench::truth {

/// What forgive_holes() has to know of a mesh with holes.
struct HoleTest {
  CutOut cut_out;
  std::vector<std::uint32_t> indices;  ///< three per triangle that is traced

  /// Whether a point of a triangle, given by the weights of its second and third corner, is a hole.
  bool is_hole(std::uint32_t triangle, float u, float v) const;
};

/// Rejects hits that lie in holes, as a filter function of Embree. The geometry's user data must be a HoleTest.
void forgive_holes(const RTCFilterFunctionNArguments* arguments);

}  // namespace shadowbench::truth
