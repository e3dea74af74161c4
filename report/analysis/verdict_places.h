#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

namespace shadowbench::analysis {

/// Where something was found: the scenes, by picture size ("480 × 270") and map size.
using VerdictPlaces = std::map<std::pair<std::string, int>, std::vector<std::string>>;

/// Writes places, what they share said once: "cubes, stack, picture 480 × 270, map 512, 1024". A scene that is listed
/// several times, for several lights, biases or fits, is named once, with their number.
std::string describe_places(const VerdictPlaces& places);

}  // namespace shadowbench::analysis
