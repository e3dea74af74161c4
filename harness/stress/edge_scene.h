#pragma once

#include <cstddef>
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

/// Judges a filter on a straight edge against what it must be, within kVisibleError. Kinds other than stochastic must
/// rise from dark to light.
Observation judge_edge(const LookupResult& seen, std::vector<double> expected, filters::FilterKind kind);

/// The depths on both sides of an edge: an occluder, and the receivers' own.
struct EdgeDepths {
  float occluder = 0.0f;
  float receiver = 1.0f;
};

/// A map of horizontal bands, each split by an edge down the middle: left the occluder, right the receivers' surface.
/// Across each edge stand receivers, at the depth of their band's surface, whose kernel holds both depths and nothing
/// else.
struct EdgeScene {
  SyntheticScene scene;
  std::vector<double> lit_share;  ///< of each receiver's kernel: the weight of its own surface, in (0,1)
  std::vector<std::size_t> band;  ///< of each receiver
  std::size_t run = 0;            ///< receivers per band, from dark to light
};

/// Makes one for a Gaussian prefilter of `radius_texels` and a map read with the bilinear tent, at texel centres; with
/// radius 0 between them. The map has room for the kernel, and as many texels as the bands need, `least_size` or more.
EdgeScene make_edge_scene(int radius_texels, const std::vector<EdgeDepths>& bands, int least_size = 64);

/// Makes one for a filter that averages the map with `kernel` and blurs nothing before: receivers anywhere between
/// texels across each edge, in the middle of a row.
EdgeScene make_edge_scene(const filters::Kernel& kernel, const std::vector<EdgeDepths>& bands);

/// Gives other depths to the same edges.
void set_depths(EdgeScene& edge, const std::vector<EdgeDepths>& bands);

}  // namespace shadowbench::stress
