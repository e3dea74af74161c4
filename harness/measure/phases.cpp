#include "harness/measure/phases.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace shadowbench::measure {
namespace {

/// Moves a part of a texel in [0,1) to [-1/2, 1/2): the grid is the same.
double center_shift(double shift) { return shift < 0.5 ? shift : shift - 1.0; }

}  // namespace

std::vector<glm::dvec2> list_phase_shifts(int count) {
  std::vector<double> places;
  for (int i = 0; i < count; ++i) places.push_back(std::fmod(i * std::numbers::phi, 1.0));
  std::vector<glm::dvec2> shifts;
  for (int i = 0; i < count; ++i) {
    const auto rank = std::ranges::count_if(places, [&](double place) { return place < places[shifts.size()]; });
    shifts.emplace_back(center_shift(static_cast<double>(i) / count), center_shift(static_cast<double>(rank) / count));
  }
  return shifts;
}

}  // namespace shadowbench::measure
