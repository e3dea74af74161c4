#include "harness/measure/phases.h"

#include <cmath>

#include "filters/random.h"

namespace shadowbench::measure {
namespace {

constexpr std::size_t kFewestOfPairs = 8;

double wrap(double shift) { return shift < 0.5 ? shift : shift - 1.0; }

double draw(std::uint32_t seed, std::size_t number) {
  return filters::hash_bits(filters::hash_bits(seed) + static_cast<std::uint32_t>(number)) * 0x1p-32;
}

}  // namespace

std::size_t count_phases_of_group(std::size_t phases) { return phases >= kFewestOfPairs && phases % 2 == 0 ? 2 : 1; }

std::vector<glm::dvec2> list_phase_shifts(int count, std::uint32_t seed) {
  const std::size_t of_group = count_phases_of_group(static_cast<std::size_t>(count));
  std::vector<glm::dvec2> shifts;
  for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i) {
    const std::size_t group = i / of_group;
    const double half = i % of_group == 0 ? 0.0 : 0.5;
    const glm::dvec2 start =
        group == 0 ? glm::dvec2(0.0) : glm::dvec2(draw(seed, 2 * group), draw(seed, 2 * group + 1));
    shifts.emplace_back(wrap(std::fmod(start.x + half, 1.0)), wrap(std::fmod(start.y + half, 1.0)));
  }
  return shifts;
}

}  // namespace shadowbench::measure
