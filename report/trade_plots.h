#pragma once

#include <optional>
#include <string>
#include <vector>

#include "report/crossover.h"
#include "report/gnuplot.h"
#include "report/light_growth.h"
#include "report/trade.h"

namespace shadowbench::report {

/// Chooses the axis of an error or a cost over all configurations of a scope that have it.
PlotAxis choose_error_axis(const TradeScope& scope, std::size_t error);
PlotAxis choose_cost_axis(const TradeScope& scope, std::size_t cost);

/// Draws fronts for documents: for each scope RMSE against the times, the fetches and the bytes, and leaks against the
/// time, in plots/<scope>.<error>.<cost>.svg. Members are filled, joined and numbered, their names in the key; tied
/// cells are hollow, dominated ones hollow and faint. Fronts with fewer than two cells are left out.
std::vector<Plot> make_front_plots(const std::vector<TradeScope>& scopes, const std::vector<std::string>& filters,
                                   const GlRecord& gl);

/// Draws time over kernel radius, one plot per chart and state of the light, in
/// plots/<scope>.map<N>.radius.<light>.svg, crossings marked.
std::vector<Plot> make_radius_plots(const std::vector<RadiusChart>& charts, const std::vector<std::string>& filters,
                                    const GlRecord& gl);

/// Draws the time of a frame over its lights, one plot per chart of two counts or more, still and moving, in
/// plots/<scope>.map<N>.lights.svg. Both axes are logarithmic: in proportion is the slope of the grey line.
std::vector<Plot> make_light_plots(const std::vector<LightChart>& charts, const std::vector<std::string>& filters,
                                   const GlRecord& gl);

/// Gives the file of that plot, relative to the report folder.
std::string light_plot_file(const LightChart& chart);

}  // namespace shadowbench::report
