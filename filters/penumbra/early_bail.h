#pragma once

#include <algorithm>
#include <glm/glm.hpp>
#include <vector>

#include "filters/map_reader.h"
#include "filters/model.h"

namespace shadowbench::filters {

/// The end of a lookup whose first taps agree: shaders/lib/early_bail.glsl.
class EarlyBail {
 public:
  explicit EarlyBail(const ParamValues& values) : bails_(text_or(values, "bail", "none") == "agree") {}

  /// A disk's points in the order of their taps: with a bail the last first, which are those at the rim of a spiral.
  std::vector<glm::vec2> order(std::vector<glm::vec2> points) const {
    if (bails_) std::ranges::reverse(points);
    return points;
  }

  /// The mean of what a function makes of ordered points, or of the first where these agree.
  template <class T, class Compare>
  T average(const std::vector<glm::vec2>& points, Tally& tally, Compare compare) const {
    using P = Position<T>;
    T sum{};
    for (std::size_t i = 0; i < points.size(); ++i) {
      sum = sum + compare(points[i]);
      if (agrees(i, value_of(sum), tally)) return T(value_of(sum) > 0.0 ? P(1) : P(0));
    }
    return sum / T(static_cast<P>(points.size()));
  }

  /// Whether the first taps, of which i is the last so far, are all lit or all blocked; excused where a weight that is
  /// as good as none keeps them from it.
  bool agrees(std::size_t i, double sum, Tally& tally) const {
    if (!bails_ || i + 1 != kFirstTaps) return false;
    const double from_end = std::min(sum, static_cast<double>(kFirstTaps) - sum);
    if (from_end != 0.0 && from_end < kRounding) tally.excused = true;
    return from_end == 0.0;
  }

 private:
  static constexpr std::size_t kFirstTaps = 4;
  static constexpr double kRounding = 1e-3;

  bool bails_;
};

}  // namespace shadowbench::filters
