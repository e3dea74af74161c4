#include <tbb/parallel_for.h>

#include <array>

#include "filters/random.h"
#include "reference/truth/visibility.h"

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

/// Point `index` of the Sobol sequence's first two dimensions, Owen-scrambled by `seed`, as 32-bit fractions.
///
/// Different seeds give independent randomisations, each of them uniform: the mean over a scramble is unbiased, and
/// several scrambles give an honest standard error. XOR with random bits (a digital shift) keeps both properties and
/// makes a further randomisation cheaply. Cost: 64 hashes; keep the points.
/// Source: Sobol 1967; Owen 1995; scrambling by hashing after Burley 2020, Practical Hash-based Owen Scrambling, JCGT
/// 9(4).
glm::uvec2 sobol_bits(std::uint32_t index, std::uint32_t seed) {
  return {scramble(reverse_bits(index), filters::hash_bits(seed)),
          scramble(second_dimension(index), filters::hash_bits(seed ^ 0x85ebca6bu))};
}

/// The place of `index` in a shuffle that keeps every aligned run of 2^k indices together, so that a second pair of
/// dimensions, taken in this order, is as evenly spread as the first and independent of it. Source: Burley 2020,
/// section 5.
std::uint32_t shuffle_index(std::uint32_t index, std::uint32_t seed) {
  return scramble(index, filters::hash_bits(seed ^ 0xc2b2ae35u));  // a bit depends on the bits above it only
}

/// Reads 32-bit fractions as a point of [0,1)^2.
glm::dvec2 to_unit_square(glm::uvec2 bits) { return {bits.x * 0x1p-32, bits.y * 0x1p-32}; }

/// Two pairs of dimensions of one point.
struct Bits {
  glm::uvec2 first;
  glm::uvec2 second;
};

std::uint32_t mix(std::uint32_t a, std::uint32_t b) { return filters::hash_bits(a + filters::hash_bits(b)); }

std::vector<Bits> make_scramble(int max_points, std::uint32_t seed) {
  std::vector<Bits> points;
  for (std::uint32_t i = 0; i < static_cast<std::uint32_t>(max_points); ++i)
    points.push_back({sobol_bits(i, seed), sobol_bits(shuffle_index(i, seed), mix(seed, 1))});
  return points;
}

}  // namespace

SampleSets::SampleSets(int max_points, std::uint32_t seed, const Mapping& mapping)
    : max_points_(max_points), lanes_(static_cast<std::size_t>(kSets) * static_cast<std::size_t>(max_points)) {
  std::vector<std::vector<Bits>> scrambles(kScrambles);
  tbb::parallel_for(
      0, kScrambles,
      [&](int s) {
        scrambles[static_cast<std::size_t>(s)] = make_scramble(max_points, mix(static_cast<std::uint32_t>(s), seed));
      });
  tbb::parallel_for(0, kSets, [&](int set) {
    for (std::size_t s = 0; s < scrambles.size(); ++s) {
      const std::uint32_t key =
          mix(static_cast<std::uint32_t>(set) * kScrambles + static_cast<std::uint32_t>(s), ~seed);
      const glm::uvec2 shift(mix(key, 1), mix(key, 2)), other_shift(mix(key, 3), mix(key, 4));
      for (int i = 0; i < max_points; ++i) {
        const Bits& bits = scrambles[s][static_cast<std::size_t>(i)];
        const glm::dvec2 offset =
            mapping(to_unit_square(bits.first ^ shift), to_unit_square(bits.second ^ other_shift));
        Lanes& lanes =
            lanes_[static_cast<std::size_t>(set) * static_cast<std::size_t>(max_points) + static_cast<std::size_t>(i)];
        lanes.x[s] = static_cast<float>(offset.x);
        lanes.y[s] = static_cast<float>(offset.y);
      }
    }
  });
}

}  // namespace shadowbench::truth
