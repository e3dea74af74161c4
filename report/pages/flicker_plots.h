#pragma once

#include <string>

#include "report/page/gnuplot.h"
#include "report/records/flicker_record.h"

namespace shadowbench::pages {

/// Names the plot of a motion: "flicker.light.snapped.svg".
std::string flicker_plot_file(const records::FlickerMotion& motion, const records::FlickerVariant& variant);

/// Draws the mean change of visibility over the steps: a line per filter and a dashed one for the truth. The plots of a
/// motion share their scales.
page::Plot make_flicker_plot(const records::FlickerMotion& motion, const records::FlickerVariant& variant);

}  // namespace shadowbench::pages
