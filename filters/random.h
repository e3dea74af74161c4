#pragma once

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
/// the eye averages soonest. See filters/noise/.
float blue_noise_turn(glm::ivec2 pixel, std::uint32_t seed, std::uint32_t frame = 0);

/// What filters that turn a disk call `rotation`: "per-pixel", "interleaved-gradient" and "blue-noise" are the three
/// above, anything else is no turn.
float turn_of(const std::string& rotation, glm::ivec2 pixel, std::uint32_t seed, std::uint32_t frame = 0);

}  // namespace shadowbench::filters
