#include "harness/measure/mean_flip.h"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace shadowbench::measure {
namespace {

metrics::LinearPicture to_picture(const images::Image& image) {
  metrics::LinearPicture picture{image.width, image.height, {}};
  for (std::size_t i = 0; i + 2 < image.texels.size(); i += 3) {
    picture.pixels.push_back(
        glm::clamp(glm::vec3(image.texels[i], image.texels[i + 1], image.texels[i + 2]), 0.0f, 1.0f));
  }
  return picture;
}

}  // namespace

std::optional<metrics::FlipView> view_picture(const images::Image& picture, double pixels_per_degree) {
  assert(picture.channels == 3);
  if (!std::ranges::all_of(picture.texels, [](float value) { return std::isfinite(value); })) return std::nullopt;
  return metrics::view_for_flip(to_picture(picture), pixels_per_degree);
}

std::optional<double> find_mean(std::span<const float> values, std::span<const std::uint8_t> mask) {
  assert(mask.empty() || mask.size() == values.size());
  double sum = 0.0, count = 0.0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (!mask.empty() && !mask[i]) continue;
    sum += static_cast<double>(values[i]);
    count += 1.0;
  }
  if (count == 0.0) return std::nullopt;
  return sum / count;
}

std::optional<double> measure_mean_flip(const std::optional<metrics::FlipView>& a,
                                        const std::optional<metrics::FlipView>& b, std::span<const std::uint8_t> mask) {
  if (!a || !b) return std::nullopt;
  return find_mean(metrics::measure_flip(*a, *b), mask);
}

std::optional<double> measure_mean_flip(const images::Image& a, const images::Image& b,
                                        std::span<const std::uint8_t> mask, double pixels_per_degree) {
  return measure_mean_flip(view_picture(a, pixels_per_degree), view_picture(b, pixels_per_degree), mask);
}

}  // namespace shadowbench::measure
