#include "harness/run/mean_flip.h"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace shadowbench::run {
namespace {

reference::LinearPicture to_picture(const report::Image& image) {
  reference::LinearPicture picture{image.width, image.height, {}};
  for (std::size_t i = 0; i + 2 < image.texels.size(); i += 3) {
    picture.pixels.push_back(
        glm::clamp(glm::vec3(image.texels[i], image.texels[i + 1], image.texels[i + 2]), 0.0f, 1.0f));
  }
  return picture;
}

bool is_finite(const report::Image& image) {
  return std::all_of(
      image.texels.begin(), image.texels.end(), [](float value) { return std::isfinite(value); });
}

}  // namespace

std::optional<reference::FlipView> view_picture(const report::Image& picture, double pixels_per_degree) {
  assert(picture.channels == 3);
  if (!is_finite(picture)) return std::nullopt;
  return reference::view_for_flip(to_picture(picture), pixels_per_degree);
}

std::optional<double> measure_mean_flip(const std::optional<reference::FlipView>& a,
                                        const std::optional<reference::FlipView>& b,
                                        std::span<const std::uint8_t> mask) {
  if (!a || !b) return std::nullopt;
  const std::vector<float> flip = reference::measure_flip(*a, *b);
  assert(mask.empty() || mask.size() == flip.size());
  double sum = 0.0, count = 0.0;
  for (std::size_t i = 0; i < flip.size(); ++i) {
    if (!mask.empty() && !mask[i]) continue;
    sum += static_cast<double>(flip[i]);
    count += 1.0;
  }
  if (count == 0.0) return std::nullopt;
  return sum / count;
}

std::optional<double> measure_mean_flip(const report::Image& a, const report::Image& b,
                                        std::span<const std::uint8_t> mask, double pixels_per_degree) {
  return measure_mean_flip(view_picture(a, pixels_per_degree), view_picture(b, pixels_per_degree), mask);
}

}  // namespace shadowbench::run
