#pragma once

#include <string>
#include <vector>

#include "report/records/records.h"

namespace shadowbench::analysis {

/// Points to each of some cells, in their order. Requires that the cells outlive what is returned.
std::vector<const records::CellRecord*> point_to(const std::vector<records::CellRecord>& cells);

/// Names what a filter is judged on: a scene, seen from one of its views.
struct Place {
  std::string scene;
  std::string view;
  bool operator==(const Place&) const = default;
};

/// Returns where a cell was measured.
Place place_of(const records::CellRecord& cell);

/// Lists where cells were measured, each place once, in the order in which they appear.
std::vector<Place> list_places(const std::vector<const records::CellRecord*>& cells);

/// The index of a cell's place; their number where it is none of them.
std::size_t find_place(const std::vector<Place>& places, const records::CellRecord& cell);

/// Names a place for people: its scene, and its view where the scene has several.
std::string describe_place(const Place& place, const std::vector<Place>& places);

/// The cells that differ in nothing but scene and view: what a renderer would choose as a whole.
struct Configuration {
  std::string name;                               ///< by records::CellNames
  std::string surroundings;                       ///< canonical settings without filter and parameters
  std::vector<const records::CellRecord*> cells;  ///< in the order of the run; never empty
};

/// Groups cells into configurations, in the order in which each first appears; no two have one name.
/// Requires that the cells outlive what is returned.
std::vector<Configuration> list_configurations(const std::vector<const records::CellRecord*>& cells);

/// The width of its kernel as records::describe_kernel(), or the range of its widths where the light chose them.
std::string describe_kernel(const Configuration& configuration);

}  // namespace shadowbench::analysis
