#pragma once

#include <functional>
#include <string>

#include "report/images/image.h"
#include "report/images/text.h"

namespace shadowbench::images {

/// Colours an image of one channel pixel by pixel; display values, 3 channels.
Image color_values(const Image& values, const std::function<Rgb(float)>& color_of);

/// Colours an image of one channel, values in [0,1], by one of OpenImageIO's colour maps ("viridis", ...); as above.
Image color_values(const Image& values, const std::string& map);

/// Makes an image of one channel that goes from 0 at the left to 1 at the right: what a colour bar is drawn from.
Image make_ramp(int width, int height);

}  // namespace shadowbench::images
