#pragma once

#include <string>
#include <vector>

#include "report/records/bias_record.h"

namespace shadowbench::pages {

/// Is a place in a chart, in units of its view box; y down.
struct ChartPoint {
  double x = 0.0;
  double y = 0.0;

  bool operator==(const ChartPoint&) const = default;
};

/// Places a factor and a rate in a chart whose factors are `factors`, ascending: equal steps for them whatever their
/// ratio, and heights by the square root of the rate, so that 1 % shows. Requires that `factor` is one of them.
ChartPoint place_in_chart(const std::vector<double>& factors, double factor, double rate);

/// Gives the factors that a mode's curves have, ascending and once each.
std::vector<double> list_factors(const records::BiasModeRecord& mode);

/// Names a factor: "0", "1/8", "4".
std::string name_factor(double factor);

/// Draws a mode's curves as SVG: acne solid, contact gap dashed, theory as a vertical line; what is absent is left out,
/// and said where a whole kind is. Colours are classes c0 .. c9 by the filter's place in `filters`, marks change with
/// it too.
std::string make_bias_chart(const records::BiasModeRecord& mode, const std::vector<std::string>& filters);

/// Makes the list of colours and marks of the filters that a mode was swept for; `filters` as for make_bias_chart().
std::string make_bias_legend(const records::BiasModeRecord& mode, const std::vector<std::string>& filters);

}  // namespace shadowbench::pages
