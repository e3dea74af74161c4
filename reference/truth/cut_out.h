#pragma once

#include <cstdint>
#include <vector>

#include "reference/truth/occluders.h"

struct RTCFilterFunctionNArguments;

namespace shadowbench::truth {

/// What Embree calls for hits on a mesh with holes.
struct HoleTest {
  CutOut cut_out;
  std::vector<std::uint32_t> indices;  ///< three per triangle that is traced

  /// Whether a point of a triangle, given by the weights of its second and third corner, is a hole.
  bool is_hole(std::uint32_t triangle, float u, float v) const;
};

/// Forgives hits in holes; the geometry's user data is a HoleTest.
void forgive_holes(const RTCFilterFunctionNArguments* arguments);

}  // namespace shadowbench::truth
