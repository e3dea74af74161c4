#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <string>

namespace shadowbench::filters {

/// Mixes the bits of an integer so that close inputs give unrelated outputs.
/// Source: Wellons 2018, hash-prospector, "lowbias32". The same in shaders/lib/random.glsl.
std::uint32_t hash_bits(std::uint32_t x);

/// A turn in [0,1) from a pixel and the run's seed: white noise.
float random_turn(glm::ivec2 pixel, std::uint32_t seed);

/// A turn in [0,1) that differs strongly between neighbouring pixels: interleaved gradient noise. Source: Jimenez 2014,
/// Next Generation Post Processing in Call of Duty: Advanced Warfare, SIGGRAPH; here in 32-bit fixed point, because its
/// floating-point form differs between machines.
float interleaved_gradient_turn(glm::ivec2 pixel);

/// A turn in [0,1) from a repeating texture of 64x64 pixels, which the seed shifts: blue noise, of which neighbours
/// differ and which the eye averages soonest. See filters/noise/.
float blue_noise_turn(glm::ivec2 pixel, std::uint32_t seed);

/// What filters that turn a disk call `rotation`: "per-pixel", "interleaved-gradient" and "blue-noise" are the three
/// above, anything else is no turn.
float turn_of(const std::string& rotation, glm::ivec2 pixel, std::uint32_t seed);

}  // namespace shadowbench::filters
