#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <string>
#include <vector>

#include "filters/filter_spec.h"

namespace shadowbench::filters {

/// Mixes the bits of an integer so that close inputs give unrelated outputs.
/// Source: Wellons 2018, hash-prospector, "lowbias32". The same in shaders/lib/random.glsl.
std::uint32_t hash_bits(std::uint32_t x);

// Turns in [0,1) of a pixel. Each frame of those that are accumulated has others: white noise is drawn anew, and the
// other two turn on by the golden ratio, so that the turns of one pixel are evenly spread over any number of frames.
// Source: Wolfe 2017, Animating Noise For Integration Over Time 2: Uniform Over Time, blog.demofox.org.

/// White noise, by the run's seed.
float random_turn(glm::ivec2 pixel, std::uint32_t seed, std::uint32_t frame = 0);

/// Differs strongly between neighbouring pixels: interleaved gradient noise. Source: Jimenez 2014, Next Generation Post
/// Processing in Call of Duty: Advanced Warfare, SIGGRAPH; here in 32-bit fixed point, because its floating-point form
/// differs between machines.
float interleaved_gradient_turn(glm::ivec2 pixel, std::uint32_t frame = 0);

/// From a repeating texture of 64x64 pixels, which the seed shifts: blue noise, of which neighbours differ and which
/// the eye averages soonest.
float blue_noise_turn(glm::ivec2 pixel, std::uint32_t seed, std::uint32_t frame = 0);

/// What filters that turn a disk call `rotation`: "per-pixel", "interleaved-gradient" and "blue-noise" are the three
/// above, anything else is no turn.
float turn_of(const std::string& rotation, glm::ivec2 pixel, std::uint32_t seed, std::uint32_t frame = 0);

inline constexpr std::size_t kBlueNoiseSide = 64;  ///< a power of two

/// Ranks 0 .. 4095, row by row, each once, and those below any limit spread evenly; the texture repeats. Cost: 0.03 s
/// when first asked for. Source: Ulichney 1993, The void-and-cluster method for dither array generation, SPIE 1913.
using BlueNoise = std::array<std::uint16_t, kBlueNoiseSide * kBlueNoiseSide>;
const BlueNoise& blue_noise();

/// A rank as a number in [0,1), which single precision holds exactly.
inline float rank_to_turn(std::uint16_t rank) {
  return static_cast<float>(rank) / static_cast<float>(kBlueNoiseSide * kBlueNoiseSide);
}

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
