#pragma once

#include <vector>

#include "harness/stress/synthetic_scene.h"

namespace shadowbench::stress {

/// The widest kernel that a straight edge has room for, in texels: half its map.
inline constexpr int kWidestRadius = 64;

/// Makes a map with a straight edge down its middle, left an occluder, right the receivers' own surface, and receivers
/// across the edge from dark to light, whose kernels of `radius_texels` and a bilinear reading lie within the map.
/// Requires 0 <= radius_texels <= kWidestRadius.
SyntheticScene make_straight_edge(double radius_texels);

/// What a kernel leaves lit of each receiver: every texel of it compared with the receiver's depth.
std::vector<double> compare_whole_kernel(const SyntheticScene& scene, const filters::Kernel& kernel);

/// Judges a filter on a straight edge against what it must be. Kinds other than stochastic must rise from dark to
/// light.
Observation judge_edge(const LookupResult& seen, std::vector<double> expected, double bound, filters::FilterKind kind);

}  // namespace shadowbench::stress
