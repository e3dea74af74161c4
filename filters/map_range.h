#pragma once

#include <string>
#include <vector>

namespace shadowbench::filters {

/// What a lookup reads outside the map.
enum class Border {
  kBorder,  ///< depth 1, or its encoding: lit. The right one
  kEdge,    ///< the nearest texel of the map: casters at its edge are smeared outwards
  kRepeat,  ///< the map over and over: its shadows are tiled
};

/// What a lookup does with receivers that the map says nothing about. The defaults are right; each other choice shows
/// an artefact.
struct RangeRule {
  Border border = Border::kBorder;
  bool far_test = true;  ///< beyond the far plane is lit; without, it is compared with depths that cannot reach it
  bool behind_test =
      true;  ///< projective maps: behind the light is lit; without, the map is mirrored through the light
};

/// Lists the names of the borders, in the order of the enumerators: border, edge, repeat.
const std::vector<std::string>& border_names();

/// A border's name.
const std::string& to_string(Border border);

/// The border of that name. Throws Error(kUsage) for any other, with the names that there are.
Border parse_border(const std::string& name);

}  // namespace shadowbench::filters
