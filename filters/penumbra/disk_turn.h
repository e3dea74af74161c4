#pragma once

#include <cmath>
#include <glm/glm.hpp>
#include <numbers>

#include "filters/map_reader.h"
#include "filters/random.h"

namespace shadowbench::filters {

/// How a disk of points is turned at a pixel: `find_turn` and `rotate` of shaders/lib/disk.glsl.
template <class T>
class DiskTurn {
  using P = Position<T>;

 public:
  DiskTurn(const std::string& rotation, glm::ivec2 pixel, std::uint32_t seed) {
    const P angle = P(2) * std::numbers::pi_v<P> * static_cast<P>(turn_of(rotation, pixel, seed));
    cosine_ = std::cos(angle);
    sine_ = std::sin(angle);
  }

  /// Where a point of the unit disk lies in a disk of this radius.
  Offset<T> place(P radius, const glm::vec2& point) const {
    const P x = static_cast<P>(point.x), y = static_cast<P>(point.y);
    return {radius * (cosine_ * x - sine_ * y), radius * (sine_ * x + cosine_ * y)};
  }

 private:
  P cosine_, sine_;
};

}  // namespace shadowbench::filters
