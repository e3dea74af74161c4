#include "report/regress/pixel_change.h"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace shadowbench::regress {
namespace {

constexpr float kNegligibleBound = 0x1p-14f;

/// What a pixel was given, of coarse bounds: 0 stands for anything below kNegligibleBound.
float bound_at(const images::Image& rounding, std::size_t i) {
  return rounding.empty() ? 0.0f : std::max(rounding.texels[i], kNegligibleBound);
}

float coarsen(float bound) {
  if (bound == images::kMayFlip) return bound;
  if (bound < kNegligibleBound) return 0.0f;
  if (!(bound < kWidestBound)) return 1.0f;
  return std::exp2(std::ceil(std::log2(bound)));
}

bool says_nothing(float bound) { return bound >= kWidestBound && bound != images::kMayFlip; }

}  // namespace

images::Image coarsen_rounding(const images::Image& rounding) {
  images::Image coarse = rounding;
  for (float& bound : coarse.texels) bound = coarsen(bound);
  return coarse;
}

PixelChange compare_pixels(const CellImages& actual, const CellImages& expected, double tolerance) {
  assert(actual.visibility.texels.size() == expected.visibility.texels.size());
  PixelChange change;
  const images::Image bounds = coarsen_rounding(actual.uncertainty.rounding),
                      known_bounds = coarsen_rounding(expected.uncertainty.rounding);
  const auto width = static_cast<std::size_t>(actual.visibility.width);
  for (std::size_t i = 0; i < actual.visibility.texels.size(); ++i) {
    const float own = bound_at(bounds, i), known = bound_at(known_bounds, i);
    // A pixel that is not finite on both sides counts as the same; the metric 'nan' limits how many there are.
    const bool same = !std::isfinite(actual.visibility.texels[i]) && !std::isfinite(expected.visibility.texels[i]);
    const bool finite =
        same || (std::isfinite(actual.visibility.texels[i]) && std::isfinite(expected.visibility.texels[i]));
    const double difference = same     ? 0.0
                              : finite ? std::abs(static_cast<double>(actual.visibility.texels[i]) -
                                                  static_cast<double>(expected.visibility.texels[i]))
                                       : 1.0;
    if (known == images::kMayFlip || says_nothing(known)) ++change.excused_expected;
    const bool flips = own == images::kMayFlip || known == images::kMayFlip;
    if (finite && (flips || says_nothing(own) || says_nothing(known))) {
      ++(flips ? change.excused_flips : change.excused_rounding);
      change.excused_squares += difference * difference;
      // Where rounding moves a pixel far, another rounding moves it: not farther than it could with the widest bounds.
      const double most = flips ? tolerance : tolerance + 2.0 * static_cast<double>(kWidestBound);
      if (difference > most) ++change.excused_changed;
      continue;
    }
    ++change.compared;
    if (!finite || difference > tolerance + static_cast<double>(own) + static_cast<double>(known)) ++change.changed;
    change.mean += difference;
    change.rms += difference * difference;
    if (difference <= change.max) continue;
    change.max = difference;
    change.max_x = static_cast<int>(i % width);
    change.max_y = static_cast<int>(i / width);
  }
  const double count = change.compared > 0 ? static_cast<double>(change.compared) : 1.0;
  change.mean /= count;
  change.rms = std::sqrt(change.rms / count);
  return change;
}

}  // namespace shadowbench::regress
