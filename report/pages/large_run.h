#pragma once

#include <cstddef>

namespace shadowbench::pages {

/// A run of more cells than this has a page without what nobody could look through: the tables and bars of every scene
/// and map, and what is beaten in the charts of fronts. The CSV files have all of it.
inline constexpr std::size_t kMostCellsInDetail = 2000;

}  // namespace shadowbench::pages
