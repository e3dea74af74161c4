#pragma once

#include <string>
#include <vector>

#include "report/page/gnuplot.h"
#include "report/records/stress_record.h"

namespace shadowbench::pages {

/// Names the plot of an axis: "stress.esm-exponent.svg".
std::string plot_file(const records::StressAxis& axis);

/// Says whether an axis has anything to plot: one observation or more.
bool has_plot(const records::StressAxis& axis);

/// Draws what was measured over an axis' quantity: a line per case, the same colour for the levels of one variant, the
/// model's dashed; broken points filled, at the upper edge where nothing finite was measured; the bound, and
/// theoretical limits as vertical lines, dashed. Zeros are left out where the scale is logarithmic.
page::Plot make_stress_plot(const records::StressAxis& axis);

}  // namespace shadowbench::pages
