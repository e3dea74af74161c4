#pragma once

#include <array>
#include <vector>

#include "report/images/image.h"

namespace shadowbench::images {

/// Maps a signed value to a colour for display, sRGB in [0,1]: blue below 0, near white at 0, red above; `scale` and
/// beyond get the full colour.
std::array<float, 3> map_diverging(float value, float scale);

/// Chooses one scale for several signed images, so that their colours compare: the 95th percentile of the magnitudes
/// from 0.001 on (rounding errors, which fill whole images, have no say), rounded up to 1, 2 or 5 times a power of ten,
/// at least 0.01. Values that are not finite are passed over.
double choose_error_scale(const std::vector<const Image*>& errors);

}  // namespace shadowbench::images
