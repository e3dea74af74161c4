#include "filters/gaussian.h"

#include <cmath>
#include <cstddef>

namespace shadowbench::filters {

std::vector<float> gaussian_weights(int radius_texels) {
  if (radius_texels == 0) return {1.0f};
  std::vector<double> exact;
  double sum = 0.0;
  for (int i = -radius_texels; i <= radius_texels; ++i) {
    const double deviations = 2.0 * i / radius_texels;
    exact.push_back(std::exp(-0.5 * deviations * deviations));
    sum += exact.back();
  }
  std::vector<float> weights;
  for (const double weight : exact) weights.push_back(static_cast<float>(weight / sum));
  return weights;
}

}  // namespace shadowbench::filters
