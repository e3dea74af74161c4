#pragma once

#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "report/images/figure.h"

namespace shadowbench::images {

/// What stands for a value that no scale can show: NaN, infinite, or broken.
inline constexpr Rgb kMagenta{1.0f, 0.0f, 1.0f};

/// Gives a value its colour, for display.
using Colors = std::function<Rgb(float)>;

/// One of OpenImageIO's colour maps ("viridis", ...), of values in [0,1].
Colors color_map(const std::string& name);

/// Maps a signed value to a colour for display, sRGB in [0,1]: blue below 0, near white at 0, red above; `scale` and
/// beyond get the full colour.
Rgb map_diverging(float value, float scale);

/// Grey from black, 0, to white, 1; magenta what is not finite.
Rgb map_grey(float value);

/// Colours an image of one channel pixel by pixel; display values, 3 channels.
Image color_values(const Image& values, const Colors& color_of);

/// Hatches an image of 3 channels where `mask`, of its size and 1 channel, is 0: what has no value there.
void hatch_image(Image& colors, const Image& mask);

/// Makes an image of one channel that goes from 0 at the left to 1 at the right: what a colour bar is drawn from.
Image make_ramp(int width, int height);

/// How values become colours, as a function of them, and what a bar of the colours says.
struct ColorScale {
  std::function<double(double)> place;  ///< of a value: 0 at the bar's left end, 1 at its right; NaN: not on the bar
  Colors color;                         ///< of a place in [0,1]; places beyond count as the ends
  std::vector<std::pair<double, std::string>> ticks;  ///< values in rising order, and what stands there
  Colors off_bar = [](float) { return kMagenta; };    ///< of a value that is not on the bar or not finite

  Rgb operator()(float value) const;
};

/// Makes a linear scale from `low` to `high` with ticks at its ends and equal parts between them.
ColorScale make_linear_scale(double low, double high, int parts, Colors color);

/// Makes a scale from -limit to limit, blue, near white and red.
ColorScale make_signed_scale(double limit);

/// Makes the cell of a scale's bar, with words above it.
Cell make_color_bar(const ColorScale& scale, const std::string& words = {}, int width = kColumnWidth);

/// Chooses one scale for several signed images, so that their colours compare: the 95th percentile of the magnitudes
/// from 0.001 on (rounding errors, which fill whole images, have no say), rounded up to 1, 2 or 5 times a power of ten,
/// at least 0.01. Values that are not finite are passed over.
double choose_error_scale(const std::vector<const Image*>& errors);

}  // namespace shadowbench::images
