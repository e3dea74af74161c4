#pragma once

#include <vector>

namespace shadowbench::filters {

/// The weights of the prefilter for texels -radius .. radius; they sum to 1.
///
/// A Gaussian with a standard deviation of half the radius, so that the outermost weight is e^-2 of the middle one;
/// radius 0 is one texel. Shared by the shaders (as a uniform) and the models.
std::vector<float> gaussian_weights(int radius_texels);

}  // namespace shadowbench::filters
