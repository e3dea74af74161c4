#pragma once

#include <functional>
#include <string>
#include <vector>

#include "report/images/figure.h"
#include "report/records/stress_record.h"

namespace shadowbench::stress {

/// One axis of a heat map, linear.
struct HeatAxis {
  std::string label;  ///< quantity and unit
  records::StressRange range;
  std::vector<double> ticks;
};

/// A quantity over two others, with a curve over it.
struct HeatMap {
  std::string title;
  std::string note;
  std::string quantity;  ///< what the colours mean
  HeatAxis x;
  HeatAxis y;                           ///< upwards
  images::Image values;                 ///< 1 channel, [0, scale]; row 0 is the highest y
  double scale = 1.0;                   ///< the value with the full colour
  std::function<double(double)> curve;  ///< y of x
};

/// Shows a heat map: a value of 0 is nearly white.
images::Figure make_figure(const HeatMap& map);

}  // namespace shadowbench::stress
