#pragma once

#include <string>
#include <utility>
#include <vector>

#include "report/images/figures/fit_worst.h"
#include "report/images/image.h"

namespace shadowbench::images {

/// The width of a panel's colour bar, pixels; pictures are at most as wide.
inline constexpr int kHeatPanelWidth = 640;

using Tick = std::pair<float, std::string>;  ///< place on the colour bar, [0,1], and what stands there

/// A heat map with its colour bar.
struct HeatPanel {
  std::string title;
  std::string caption;
  Image picture;  ///< 3 channels, display values
  Image bar;      ///< likewise, as make_color_bar() coloured
  std::vector<Tick> ticks;
};

/// Fits an image of one channel into a panel's width; of pixels that fall together, the worst is kept.
Image fit_heat_panel(const Image& image, const Badness& badness);

/// Makes what a panel's colour bar is coloured from: one channel from 0 to 1.
Image make_color_bar();

/// Ticks of a bar from -scale to scale.
std::vector<Tick> list_signed_ticks(double scale);

/// Draws panels in two columns below a title and a note. Requires one panel at least. Display values, 3 channels.
/// Throws Error(kOutput) where the font is not installed.
Image draw_heat_panels(const std::string& title, const std::string& note, const std::vector<HeatPanel>& panels);

}  // namespace shadowbench::images
