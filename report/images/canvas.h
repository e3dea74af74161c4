#pragma once

#include <array>
#include <functional>

#include "report/images/image.h"

namespace shadowbench::images {

/// A colour in the space of the canvas.
using Rgb = std::array<float, 3>;

/// Fills what of a rectangle lies on a canvas of 3 channels.
void fill_rect(Image& canvas, const Rect& rect, const Rgb& color);

/// Draws a line of `width` pixels around a rectangle, outside it; what of it lies on the canvas.
void outline_rect(Image& canvas, const Rect& rect, int width, const Rgb& color);

/// Copies what lies on the canvas of a picture of as many channels, its left top corner at (x, y).
void paste_image(Image& canvas, const Image& picture, int x, int y);

/// Puts a border of `width` pixels around a picture of 3 channels.
Image frame_image(const Image& picture, int width, const Rgb& color);

/// Cuts a rectangle out of an image, in which it lies.
Image cut_image(const Image& image, const Rect& rect);

/// Returns the size at which an image of `size` is shown in a box: the largest that fits, a whole multiple of the image
/// where it is magnified.
Size fit_size(Size size, Size box);

/// Scales an image, reduced in its own space by means, or magnified by copies of its texels.
Image scale_image(const Image& image, Size size);

/// Scales an image to the size of fit_size(); an empty one stays empty.
Image fit_image(const Image& image, Size box);

/// Rates how bad a value is. Of those that fall on one pixel, the worst is shown.
using Badness = std::function<float(float)>;

/// Scales an image of one channel to the size of fit_size(), so that a single broken texel is seen. Where several are
/// as bad, the first is shown.
Image fit_worst(const Image& image, Size box, const Badness& badness);

}  // namespace shadowbench::images
