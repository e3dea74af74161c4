#pragma once

#include <glm/glm.hpp>
#include <string>
#include <vector>

#include "filters/filter_spec.h"

namespace shadowbench::filters {

/// Maps the unit square to the unit disk, equal areas to equal areas.
/// Source: Shirley and Chiu 1997, A Low Distortion Map Between Disk and Square, JGT 2(3).
glm::dvec2 map_to_disk(glm::dvec2 square);

/// The names of the patterns that points can be spread in, the first the default.
/// - `vogel`: a sunflower's spiral (Vogel 1979, A Better Way to Construct the Sunflower Head, Mathematical Biosciences
///   44): equal areas from point to point, each a golden angle on.
/// - `stratified`: one point anywhere in each cell of a grid (Cook 1986, Stochastic Sampling in Computer Graphics, ACM
///   TOG 5(1)), mapped to the disk.
/// - `blue-noise`: each point the farthest of some from those before it (Mitchell 1991, Spectrally Optimal Sampling for
///   Distribution Ray Tracing, SIGGRAPH), on a square without edges, so that none crowd there, mapped to the disk.
/// - `spiral`: as many steps inwards as points, three eighths of a turn apart, so that points crowd in the middle
///   (Jimenez 2014, Next Generation Post Processing in Call of Duty: Advanced Warfare, SIGGRAPH, with eight).
const std::vector<std::string>& disk_patterns();

/// Generates `count` points over the unit disk, evenly spread but for `spiral`; the same for the same pattern, count
/// and seed on every machine. A seed turns the spiral about the centre, and is chance for the others. All are then
/// moved so that their mean is the centre, since a mean elsewhere would shift the shadow, and scaled to fit the disk
/// where the move took one out of it. Cost: quadratic in `count` for `blue-noise`.
std::vector<glm::vec2> generate_disk_points(int count, unsigned seed, const std::string& pattern = "vogel");

/// Generates the points that `[disk.<name>]` of a filter's front matter asks for.
/// Requires that the filter declares such a table.
std::vector<glm::vec2> generate_disk_points(const FilterSpec& spec, const ParamValues& values, const std::string& name);

}  // namespace shadowbench::filters
