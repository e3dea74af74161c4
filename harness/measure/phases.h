#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

namespace shadowbench::measure {

/// How many of `phases` that follow each other make a group: two from eight on, where they are even, else one. The
/// groups are independent of each other; a mean over phases is as sure as means of groups agree.
std::size_t count_phases_of_group(std::size_t phases);

/// Where the map's grid stands in each of `count` phases: how far it is moved along its axes, each in [-1/2, 1/2)
/// texel. The first is not moved; every further group begins anywhere, by `seed`, and its second phase is half a texel
/// farther along both axes, where what depends on the phase once a texel has the opposite sign. Phases of a smaller
/// count of pairs are the first of a larger one.
/// Source: independent shifts of one set of points: Cranley and Patterson 1976, Randomization of Number Theoretic
/// Methods for Multiple Integration, SIAM Journal on Numerical Analysis 13(6); antithetic pairs: Hammersley and Morton
/// 1956.
std::vector<glm::dvec2> list_phase_shifts(int count, std::uint32_t seed);

}  // namespace shadowbench::measure
