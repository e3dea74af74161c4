#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <string>

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
/// the eye averages soonest. See make_blue_noise.cpp.
float blue_noise_turn(glm::ivec2 pixel, std::uint32_t seed, std::uint32_t frame = 0);

/// What filters that turn a disk call `rotation`: "per-pixel", "interleaved-gradient" and "blue-noise" are the three
/// above, anything else is no turn.
float turn_of(const std::string& rotation, glm::ivec2 pixel, std::uint32_t seed, std::uint32_t frame = 0);

inline constexpr std::size_t kBlueNoiseSide = 64;  ///< a power of two

/// Ranks 0 .. 4095, row by row, each once, and those below any limit spread evenly; the texture repeats. Written by
/// make_blue_noise.cpp while the project is built.
extern const std::array<std::uint16_t, kBlueNoiseSide * kBlueNoiseSide> kBlueNoise;

/// A rank as a number in [0,1), which single precision holds exactly.
inline float rank_to_turn(std::uint16_t rank) {
  return static_cast<float>(rank) / static_cast<float>(kBlueNoiseSide * kBlueNoiseSide);
}

}  // namespace shadowbench::filters
