#pragma once

#include <glm/glm.hpp>
#include <string>
#include <vector>

#include "filters/filter_spec.h"

namespace shadowbench::filters {

/// Maps the unit square to the unit disk, equal areas to equal areas.
/// Source: Shirley and Chiu 1997, A Low Distortion Map Between Disk and Square, JGT 2(3).
glm::dvec2 map_to_disk(glm::dvec2 square);

/// Generates `count` points that are spread evenly over the unit disk, those near its rim as thinly as the others; the
/// same for the same count and seed on every machine. A seed turns them about the centre.
///
/// A sunflower's spiral (Vogel 1979, A Better Way to Construct the Sunflower Head, Mathematical Biosciences 44): equal
/// areas from point to point, each a golden angle on. Then moved so that their mean is the centre, since a mean
/// elsewhere would shift the shadow, and scaled to fit the disk where the move took one out of it.
std::vector<glm::vec2> generate_disk_points(int count, unsigned seed);

/// Generates the points that `[disk.<name>]` of a filter's front matter asks for.
/// Requires that the filter declares such a table.
std::vector<glm::vec2> generate_disk_points(const FilterSpec& spec, const ParamValues& values, const std::string& name);

}  // namespace shadowbench::filters
