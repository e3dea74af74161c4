#include "reference/truth/sobol.h"

#include <array>

#include "filters/random.h"

namespace shadowbench::truth {
namespace {

constexpr int kBits = 32;

/// The second dimension's direction numbers, of the primitive polynomial x + 1: Pascal's triangle modulo 2.
constexpr std::array<std::uint32_t, kBits> make_directions() {
  std::array<std::uint32_t, kBits> directions{};
  directions[0] = 1u << 31;
  for (int i = 1; i < kBits; ++i) {
    const std::uint32_t previous = directions[static_cast<std::size_t>(i - 1)];
    directions[static_cast<std::size_t>(i)] = previous ^ (previous >> 1);
  }
  return directions;
}

std::uint32_t reverse_bits(std::uint32_t x) {
  std::uint32_t reversed = 0;
  for (int i = 0; i < kBits; ++i) reversed |= ((x >> i) & 1u) << (kBits - 1 - i);
  return reversed;
}

std::uint32_t second_dimension(std::uint32_t index) {
  static constexpr std::array<std::uint32_t, kBits> kDirections = make_directions();
  std::uint32_t bits = 0;
  for (std::size_t i = 0; index; index >>= 1, ++i)
    if (index & 1u) bits ^= kDirections[i];
  return bits;
}

/// Flips each bit by a hash of the bits above it, which is what Owen's nested scrambling asks for.
std::uint32_t scramble(std::uint32_t bits, std::uint32_t seed) {
  std::uint32_t result = 0;
  for (int i = 0; i < kBits; ++i) {
    const std::uint32_t above = i == 0 ? 0u : bits >> (kBits - i);
    const std::uint32_t flip =
        filters::hash_bits(above ^ filters::hash_bits(seed + 0x9e3779b9u * static_cast<std::uint32_t>(i + 1))) & 1u;
    result |= (((bits >> (kBits - 1 - i)) & 1u) ^ flip) << (kBits - 1 - i);
  }
  return result;
}

}  // namespace

glm::uvec2 sobol_bits(std::uint32_t index, std::uint32_t seed) {
  return {scramble(reverse_bits(index), filters::hash_bits(seed)),
          scramble(second_dimension(index), filters::hash_bits(seed ^ 0x85ebca6bu))};
}

std::uint32_t shuffle_index(std::uint32_t index, std::uint32_t seed) {
  return scramble(index, filters::hash_bits(seed ^ 0xc2b2ae35u));  // a bit depends on the bits above it only
}

}  // namespace shadowbench::truth
