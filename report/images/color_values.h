#pragma once

#include <functional>
#include <string>
#include <vector>

#include "report/images/image.h"
#include "report/images/text.h"

namespace shadowbench::images {

/// Colours an image of one channel pixel by pixel; display values, 3 channels.
Image color_values(const Image& values, const std::function<Rgb(float)>& color_of);

/// Colours an image of one channel, values in [0,1], by one of OpenImageIO's colour maps ("viridis", ...); as above.
Image color_values(const Image& values, const std::string& map);

/// Makes an image of one channel that goes from 0 at the left to 1 at the right: what a colour bar is drawn from.
Image make_ramp(int width, int height);

/// Maps a signed value to a colour for display, sRGB in [0,1]: blue below 0, near white at 0, red above; `scale` and
/// beyond get the full colour.
Rgb map_diverging(float value, float scale);

/// Chooses one scale for several signed images, so that their colours compare: the 95th percentile of the magnitudes
/// from 0.001 on (rounding errors, which fill whole images, have no say), rounded up to 1, 2 or 5 times a power of ten,
/// at least 0.01. Values that are not finite are passed over.
double choose_error_scale(const std::vector<const Image*>& errors);

}  // namespace shadowbench::images
