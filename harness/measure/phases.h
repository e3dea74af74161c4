#pragma once

#include <glm/glm.hpp>
#include <vector>

namespace shadowbench::measure {

/// Where the map's grid stands in each of `count` phases: how far it is moved along its axes, each in [-1/2, 1/2)
/// texel; the first is not moved. Stratified (a Latin hypercube: McKay, Beckman and Conover 1979, Technometrics 21(2)):
/// on each axis every phase lies in another of `count` equal parts of a texel, in the order of multiples of the golden
/// ratio.
std::vector<glm::dvec2> list_phase_shifts(int count);

}  // namespace shadowbench::measure
