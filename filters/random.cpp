#include "filters/random.h"

namespace shadowbench::filters {
namespace {

/// The upper 24 bits, which a float holds exactly.
float to_turn(std::uint32_t bits) { return static_cast<float>(bits >> 8) * 0x1p-24f; }

/// What a frame adds to its turns, in 2^-32 of a turn: the golden ratio.
std::uint32_t frame_bits(std::uint32_t frame) { return 2654435769U * frame; }

}  // namespace

std::uint32_t hash_bits(std::uint32_t x) {
  x ^= x >> 16;
  x *= 0x7feb352dU;
  x ^= x >> 15;
  x *= 0x846ca68bU;
  x ^= x >> 16;
  return x;
}

float random_turn(glm::ivec2 pixel, std::uint32_t seed, std::uint32_t frame) {
  return to_turn(hash_bits(static_cast<std::uint32_t>(pixel.x) +
                           hash_bits(static_cast<std::uint32_t>(pixel.y) + hash_bits(seed + frame_bits(frame)))));
}

float interleaved_gradient_turn(glm::ivec2 pixel, std::uint32_t frame) {
  // 0.06711056 and 0.00583715 with 32 fraction bits, 52.9829189 with 26.
  const std::uint32_t inner =
      288237660U * static_cast<std::uint32_t>(pixel.x) + 25070368U * static_cast<std::uint32_t>(pixel.y);
  const std::uint64_t product = static_cast<std::uint64_t>(inner) * 3555623499U;
  return to_turn(static_cast<std::uint32_t>(product >> 26) + frame_bits(frame));
}

float blue_noise_turn(glm::ivec2 pixel, std::uint32_t seed, std::uint32_t frame) {
  constexpr unsigned kRankShift = 20;  // from ranks to 2^-32 of a turn
  static_assert(kBlueNoise.size() << kRankShift == std::size_t{1} << 32);
  const std::uint32_t shift = hash_bits(seed);
  const std::size_t x = (static_cast<std::uint32_t>(pixel.x) + shift) % kBlueNoiseSide;
  const std::size_t y = (static_cast<std::uint32_t>(pixel.y) + (shift >> 16)) % kBlueNoiseSide;
  return to_turn((std::uint32_t{kBlueNoise[y * kBlueNoiseSide + x]} << kRankShift) + frame_bits(frame));
}

float turn_of(const std::string& rotation, glm::ivec2 pixel, std::uint32_t seed, std::uint32_t frame) {
  if (rotation == "per-pixel") return random_turn(pixel, seed, frame);
  if (rotation == "blue-noise") return blue_noise_turn(pixel, seed, frame);
  return rotation == "interleaved-gradient" ? interleaved_gradient_turn(pixel, frame) : 0.0f;
}

}  // namespace shadowbench::filters
