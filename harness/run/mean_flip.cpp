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
  return std::all_of(image.texels.begin(), image.texels.end(), [](float value) { return std::isfinite(value); });
}

}  // namespace

std::optional<double> measure_mean_flip(const report::Image& a, const report::Image& b,
                                        std::span<const std::uint8_t> mask, double pixels_per_degree) {
  assert(a.channels == 3 && b.channels == 3 && a.width == b.width && a.height == b.height);
  if (!is_finite(a) || !is_finite(b)) return std::nullopt;
  const std::vector<float> flip = reference::measure_flip(to_picture(a), to_picture(b), pixels_per_degree);
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

}  // namespace shadowbench::run
