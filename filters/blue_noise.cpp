#include <vector>

#include "filters/random.h"

namespace shadowbench::filters {
namespace {

// In integers, so that every machine makes the same texture. It repeats and the energy is a sum, so the void among ones
// is the cluster among zeros, and Ulichney's last two phases are one.

constexpr std::size_t kTexels = kBlueNoiseSide * kBlueNoiseSide;
constexpr std::size_t kFirst = kTexels / 10;  // ones in the pattern to begin with

/// A pattern of zeros and ones, with how crowded each texel's surroundings are.
class Pattern {
 public:
  Pattern() : is_one_(kTexels, false), energy_(kTexels, 0) {
    // exp(-d^2 / (2 * 1.5^2)) in steps of d^2 = 1, each 0.800737 times the one before.
    std::uint64_t weight = 1U << 24;
    for (std::uint32_t& each : gaussian_) {
      each = static_cast<std::uint32_t>(weight);
      weight = weight * 3439140958U >> 32;
    }
  }

  bool is_one(std::size_t texel) const { return is_one_[texel]; }

  void set(std::size_t texel, bool one) {
    is_one_[texel] = one;
    const int side = static_cast<int>(kBlueNoiseSide), at = static_cast<int>(texel);
    for (int dy = -kReach; dy <= kReach; ++dy) {
      for (int dx = -kReach; dx <= kReach; ++dx) {
        const int distance = dx * dx + dy * dy;
        if (distance >= kSteps) continue;
        const int x = (at % side + dx) & (side - 1), y = (at / side + dy) & (side - 1);
        const std::uint32_t weight = gaussian_[distance];
        energy_[static_cast<std::size_t>(y * side + x)] += one ? weight : 0U - weight;
      }
    }
  }

  std::size_t find_tightest_cluster() const {
    std::size_t best = kTexels;
    for (std::size_t i = 0; i < kTexels; ++i)
      if (is_one_[i] && (best == kTexels || energy_[i] > energy_[best])) best = i;
    return best;
  }

  std::size_t find_largest_void() const {
    std::size_t best = kTexels;
    for (std::size_t i = 0; i < kTexels; ++i)
      if (!is_one_[i] && (best == kTexels || energy_[i] < energy_[best])) best = i;
    return best;
  }

 private:
  static constexpr int kReach = 8, kSteps = 75;  // where the Gaussian ends
  std::vector<bool> is_one_;
  std::vector<std::uint32_t> energy_;
  std::uint32_t gaussian_[kSteps];
};

/// Few ones, at random places and then moved from clusters to voids until they stay.
Pattern make_first_pattern() {
  Pattern pattern;
  std::uint32_t state = 1;
  for (std::size_t ones = 0; ones < kFirst;) {
    state = state * 1664525U + 1013904223U;
    const std::size_t texel = (state >> 16) % kTexels;
    if (pattern.is_one(texel)) continue;
    pattern.set(texel, true);
    ++ones;
  }
  for (std::size_t from = kTexels, to = 0; from != to;) {
    from = pattern.find_tightest_cluster();
    pattern.set(from, false);
    to = pattern.find_largest_void();
    pattern.set(to, true);
  }
  return pattern;
}

BlueNoise make_ranks() {
  const Pattern first = make_first_pattern();
  BlueNoise ranks{};
  Pattern pattern = first;
  for (std::size_t rank = kFirst; rank-- > 0;) {
    const std::size_t texel = pattern.find_tightest_cluster();
    pattern.set(texel, false);
    ranks[texel] = static_cast<std::uint16_t>(rank);
  }
  pattern = first;
  for (std::size_t rank = kFirst; rank < kTexels; ++rank) {
    const std::size_t texel = pattern.find_largest_void();
    pattern.set(texel, true);
    ranks[texel] = static_cast<std::uint16_t>(rank);
  }
  return ranks;
}

}  // namespace

const BlueNoise& blue_noise() {
  static const BlueNoise ranks = make_ranks();
  return ranks;
}

}  // namespace shadowbench::filters
