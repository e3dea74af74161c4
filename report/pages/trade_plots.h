#pragma once

#include <optional>
#include <string>
#include <vector>

#include "report/analysis/crossover.h"
#include "report/analysis/light_growth.h"
#include "report/analysis/trade.h"
#include "report/page/gnuplot.h"

namespace shadowbench::pages {

/// Chooses the axis of an error or a cost over all configurations of a scope that have it.
page::PlotAxis choose_error_axis(const analysis::TradeScope& scope, std::size_t error);
page::PlotAxis choose_cost_axis(const analysis::TradeScope& scope, std::size_t cost);

/// Draws fronts for documents: for each scope RMSE against the times, the fetches and the bytes, and leaks against the
/// time, in plots/<scope>.<error>.<cost>.svg. Members are filled, joined and numbered, their names in the key; tied
/// cells are hollow, dominated ones hollow and faint. Fronts with fewer than two cells are left out.
std::vector<page::Plot> make_front_plots(const std::vector<analysis::TradeScope>& scopes,
                                         const std::vector<std::string>& filters, const records::GlRecord& gl);

/// Draws time over kernel radius, one plot per chart and state of the light, in
/// plots/<scope>.map<N>.radius.<light>.svg, crossings marked.
std::vector<page::Plot> make_radius_plots(const std::vector<analysis::RadiusChart>& charts,
                                          const std::vector<std::string>& filters, const records::GlRecord& gl);

/// Draws the time of a frame over its lights, one plot per chart of two counts or more, still and moving, in
/// plots/<scope>.map<N>.lights.svg. Both axes are logarithmic: in proportion is the slope of the grey line.
std::vector<page::Plot> make_light_plots(const std::vector<analysis::LightChart>& charts,
                                         const std::vector<std::string>& filters, const records::GlRecord& gl);

/// Gives the file of that plot, relative to the report folder.
std::string light_plot_file(const analysis::LightChart& chart);

}  // namespace shadowbench::pages
