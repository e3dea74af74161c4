#pragma once

#include <functional>

#include "report/images/image.h"

namespace shadowbench::images {

/// Rates how bad a value is. Of those that fall on one pixel, the worst is shown.
using Badness = std::function<float(float)>;

/// Scales a picture of one channel to a width, keeping its aspect: repeats the pixels of a small one, and shows the
/// worst of those that a pixel of a reduced one stands for, so that a single broken one is seen.
Image fit_worst(const Image& image, int width, const Badness& badness);

}  // namespace shadowbench::images
