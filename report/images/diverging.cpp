#include "report/images/diverging.h"

#include <algorithm>
#include <cmath>

namespace shadowbench::images {
namespace {

constexpr std::array<float, 3> kBelow{0.09f, 0.31f, 0.66f};
constexpr std::array<float, 3> kZero{0.95f, 0.95f, 0.94f};
constexpr std::array<float, 3> kAbove{0.74f, 0.09f, 0.13f};
constexpr double kSmallestScale = 0.01;
constexpr float kSmallestError = 0.001f;  // a tenth of the smallest scale: nobody sees less

double round_up_nicely(double value) {
  const double power = std::pow(10.0, std::floor(std::log10(value)));
  for (const double step : {1.0, 2.0, 5.0})
    if (value <= step * power * (1.0 + 1e-6)) return step * power;
  return 10.0 * power;
}

}  // namespace

std::array<float, 3> map_diverging(float value, float scale) {
  const float t = std::clamp(value / scale, -1.0f, 1.0f);
  const std::array<float, 3>& end = t < 0.0f ? kBelow : kAbove;
  std::array<float, 3> color;
  for (std::size_t i = 0; i < 3; ++i) color[i] = kZero[i] + std::abs(t) * (end[i] - kZero[i]);
  return color;
}

double choose_error_scale(const std::vector<const Image*>& errors) {
  std::vector<float> magnitudes;
  for (const Image* image : errors) {
    for (const float value : image->texels)
      if (std::isfinite(value) && std::abs(value) >= kSmallestError) magnitudes.push_back(std::abs(value));
  }
  if (magnitudes.empty()) return kSmallestScale;
  const auto rank = static_cast<std::ptrdiff_t>(0.95 * static_cast<double>(magnitudes.size() - 1));
  std::nth_element(magnitudes.begin(), magnitudes.begin() + rank, magnitudes.end());
  return round_up_nicely(std::max(kSmallestScale, static_cast<double>(magnitudes[static_cast<std::size_t>(rank)])));
}

}  // namespace shadowbench::images
