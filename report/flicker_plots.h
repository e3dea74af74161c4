#pragma once

#include <string>

#include "report/flicker_record.h"
#include "report/gnuplot.h"

namespace shadowbench::report {

/// Names the plot of a motion: "flicker.light.snapped.svg".
std::string flicker_plot_file(const FlickerMotion& motion, const FlickerVariant& variant);

/// Draws the mean change of visibility over the steps: a line per filter and a dashed one for the truth. The plots of a
/// motion share their scales.
Plot make_flicker_plot(const FlickerMotion& motion, const FlickerVariant& variant);

}  // namespace shadowbench::report
