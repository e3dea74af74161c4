#include "filters/random.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <numbers>

namespace shadowbench::filters {

namespace {

/// The upper 24 bits, which a float holds exactly.
float to_turn(std::uint32_t bits) { return static_cast<float>(bits >> 8) * 0x1p-24f; }

/// What a frame adds to its turns, in 2^-32 of a turn: the golden ratio.
std::uint32_t frame_bits(std::uint32_t frame) { return 2654435769U * frame; }

using Points = std::vector<glm::dvec2>;

Points spread_on_spiral(int count, unsigned seed) {
  const double golden_angle = std::numbers::pi * (3.0 - std::sqrt(5.0));
  Points points;
  for (int i = 0; i < count; ++i) {
    const double radius = std::sqrt((i + 0.5) / count), angle = golden_angle * (static_cast<double>(seed) + i);
    points.emplace_back(radius * std::cos(angle), radius * std::sin(angle));
  }
  return points;
}

/// Each point an eighth of three turns on, and nearer to the centre by the same step.
Points spread_inwards(int count, unsigned seed) {
  Points points;
  for (int i = 0; i < count; ++i) {
    const double radius = 1.0 - static_cast<double>(i) / count, angle = 0.75 * std::numbers::pi * (seed + i);
    points.emplace_back(radius * std::cos(angle), radius * std::sin(angle));
  }
  return points;
}

/// A stream of places in the unit square, in 32-bit fractions: sums and distances of them wrap as the square does.
class RandomPlaces {
 public:
  using Fractions = glm::uvec2;
  explicit RandomPlaces(unsigned seed) : state_(hash_bits(seed)) {}
  Fractions next() {
    const std::uint32_t x = hash_bits(++state_);
    return {x, hash_bits(x + state_)};
  }

 private:
  std::uint32_t state_;
};

glm::dvec2 to_square(RandomPlaces::Fractions place) { return glm::dvec2(place) * 0x1p-32; }

/// In rows of cells of equal area, as near to squares as the count allows.
Points spread_in_cells(int count, unsigned seed) {
  const int rows = std::max(1, static_cast<int>(std::sqrt(count)));
  RandomPlaces chance(seed);
  Points points;
  for (int row = 0; row < rows; ++row) {
    const int begin = count * row / rows, end = count * (row + 1) / rows;
    for (int i = begin; i < end; ++i) {
      const glm::dvec2 within = to_square(chance.next());
      points.push_back(map_to_disk(
          {(i - begin + within.x) / (end - begin), (begin + within.y * (end - begin)) / static_cast<double>(count)}));
    }
  }
  return points;
}

/// The squared distance on a square whose opposite edges are one.
std::uint64_t wrapped_distance(RandomPlaces::Fractions a, RandomPlaces::Fractions b) {
  const auto part = [](std::uint32_t d) { return static_cast<std::uint64_t>(std::min(d, 0U - d)); };
  const std::uint64_t x = part(a.x - b.x), y = part(a.y - b.y);
  return x * x + y * y;
}

Points spread_by_distance(int count, unsigned seed) {
  constexpr int kCandidates = 64;
  RandomPlaces chance(seed);
  std::vector<RandomPlaces::Fractions> chosen;
  for (int i = 0; i < count; ++i) {
    RandomPlaces::Fractions best{};
    std::uint64_t farthest = 0;
    for (int candidate = 0; candidate < kCandidates; ++candidate) {
      const RandomPlaces::Fractions place = chance.next();
      std::uint64_t nearest = std::numeric_limits<std::uint64_t>::max();
      for (const RandomPlaces::Fractions& other : chosen) nearest = std::min(nearest, wrapped_distance(place, other));
      if (nearest <= farthest) continue;
      farthest = nearest;
      best = place;
    }
    chosen.push_back(best);
  }
  Points points;
  for (const RandomPlaces::Fractions& place : chosen) points.push_back(map_to_disk(to_square(place)));
  return points;
}

Points spread(int count, unsigned seed, const std::string& pattern) {
  if (pattern == "stratified") return spread_in_cells(count, seed);
  if (pattern == "blue-noise") return spread_by_distance(count, seed);
  if (pattern == "spiral") return spread_inwards(count, seed);
  assert(pattern == "vogel");
  return spread_on_spiral(count, seed);
}

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
  static_assert(std::tuple_size_v<BlueNoise> << kRankShift == std::size_t{1} << 32);
  const std::uint32_t shift = hash_bits(seed);
  const std::size_t x = (static_cast<std::uint32_t>(pixel.x) + shift) % kBlueNoiseSide;
  const std::size_t y = (static_cast<std::uint32_t>(pixel.y) + (shift >> 16)) % kBlueNoiseSide;
  return to_turn((std::uint32_t{blue_noise()[y * kBlueNoiseSide + x]} << kRankShift) + frame_bits(frame));
}

float turn_of(const std::string& rotation, glm::ivec2 pixel, std::uint32_t seed, std::uint32_t frame) {
  if (rotation == "per-pixel") return random_turn(pixel, seed, frame);
  if (rotation == "blue-noise") return blue_noise_turn(pixel, seed, frame);
  return rotation == "interleaved-gradient" ? interleaved_gradient_turn(pixel, frame) : 0.0f;
}

glm::dvec2 map_to_disk(glm::dvec2 square) {
  const glm::dvec2 p = 2.0 * square - 1.0;
  if (p.x == 0.0 && p.y == 0.0) return p;
  const bool wide = std::abs(p.x) > std::abs(p.y);
  const double radius = wide ? p.x : p.y;
  const double quarter = std::numbers::pi / 4.0;
  const double angle = wide ? quarter * (p.y / p.x) : 2.0 * quarter - quarter * (p.x / p.y);
  return {radius * std::cos(angle), radius * std::sin(angle)};
}

const std::vector<std::string>& disk_patterns() {
  static const std::vector<std::string> names{"vogel", "stratified", "blue-noise", "spiral"};
  return names;
}

std::vector<glm::vec2> generate_disk_points(int count, unsigned seed, const std::string& pattern) {
  const Points points = spread(count, seed, pattern);
  glm::dvec2 mean(0.0);
  for (const glm::dvec2& point : points) mean += point / static_cast<double>(count);
  double reach = 1.0;
  for (const glm::dvec2& point : points) reach = std::max(reach, glm::length(point - mean));
  std::vector<glm::vec2> result;
  for (const glm::dvec2& point : points) result.emplace_back((point - mean) / reach);
  return result;
}

std::vector<glm::vec2> generate_disk_points(const FilterSpec& spec, const ParamValues& values,
                                            const std::string& name) {
  const auto disk =
      std::find_if(spec.disks.begin(), spec.disks.end(), [&](const DiskTable& d) { return d.name == name; });
  assert(disk != spec.disks.end());
  return generate_disk_points(static_cast<int>(number(values, disk->count)), disk->seed,
                              text_or(values, disk->pattern, disk->pattern));
}

}  // namespace shadowbench::filters
