#include "reference/truth/sample_sets.h"

#include <tbb/parallel_for.h>

#include "filters/random.h"
#include "reference/truth/sobol.h"

namespace shadowbench::truth {
namespace {

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
