#pragma once

#include <string>
#include <vector>

#include "report/analysis/crossover.h"
#include "report/analysis/light_growth.h"
#include "report/analysis/trade.h"
#include "report/page/chart.h"

namespace shadowbench::pages {

/// Draws the fronts of every scope, error and cost. Members are filled and joined; tied cells are hollow, dominated
/// ones hollow and faint. Those, and curves over the width, are left out of a run of more than kMostCellsInDetail
/// cells.
page::ChartChoice make_front_choice(const std::vector<analysis::TradeScope>& scopes,
                                    const std::vector<records::CellRecord>& cells, const records::GlRecord& gl);

/// Draws time over kernel width for every chart and state of the light, crossings marked.
page::ChartChoice make_width_choice(const std::vector<analysis::WidthChart>& charts,
                                    const std::vector<std::string>& filters, const records::GlRecord& gl);

/// Draws the time of a frame over its lights, still and moving. Both axes are logarithmic: in proportion is the slope
/// of the grey line. Requires two counts or more.
page::Chart make_light_chart(const analysis::LightChart& chart, const std::vector<std::string>& filters,
                             const records::GlRecord& gl);

}  // namespace shadowbench::pages
