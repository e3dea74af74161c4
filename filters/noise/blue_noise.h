#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace shadowbench::filters {

inline constexpr std::size_t kBlueNoiseSide = 64;  ///< a power of two

/// Ranks 0 .. 4095, row by row, each once, and those below any limit spread evenly; the texture repeats. Written by
/// make_blue_noise.cpp while the project is built.
extern const std::array<std::uint16_t, kBlueNoiseSide * kBlueNoiseSide> kBlueNoise;

/// A rank as a number in [0,1), which single precision holds exactly.
inline float rank_to_turn(std::uint16_t rank) {
  return static_cast<float>(rank) / static_cast<float>(kBlueNoiseSide * kBlueNoiseSide);
}

}  // namespace shadowbench::filters
