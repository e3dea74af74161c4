#pragma once

#include <cstdint>
#include <glm/glm.hpp>

namespace shadowbench::truth {

/// Point `index` of the Sobol sequence's first two dimensions, Owen-scrambled by `seed`, as 32-bit fractions.
///
/// Different seeds give independent randomisations, each of them uniform: the mean over a scramble is unbiased, and
/// several scrambles give an honest standard error. XOR with random bits (a digital shift) keeps both properties and
/// makes a further randomisation cheaply. Cost: 64 hashes; keep the points.
/// Source: Sobol 1967; Owen 1995; scrambling by hashing after Burley 2020, Practical Hash-based Owen Scrambling, JCGT
/// 9(4).
glm::uvec2 sobol_bits(std::uint32_t index, std::uint32_t seed);

/// The place of `index` in a shuffle that keeps every aligned run of 2^k indices together, so that a second pair of
/// dimensions, taken in this order, is as evenly spread as the first and independent of it. Source: Burley 2020,
/// section 5.
std::uint32_t shuffle_index(std::uint32_t index, std::uint32_t seed);

/// Reads 32-bit fractions as a point of [0,1)^2.
inline glm::dvec2 to_unit_square(glm::uvec2 bits) { return {bits.x * 0x1p-32, bits.y * 0x1p-32}; }

}  // namespace shadowbench::truth
