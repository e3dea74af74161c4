#pragma once

#include <functional>
#include <string>
#include <vector>

#include "harness/stress/axis.h"
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

/// A mistake that a comparison of filters can make: one filter in a set-up whose map overflows.
struct Mistake {
  std::string scene;                ///< built-in
  std::vector<std::string> setups;  ///< as --filters reads them: the one that overflows, the corrected one, and more
  std::vector<std::string> others;  ///< what it is compared with
};

/// Replays a mistake on the scene's first view: the error of every set-up against the area truth, the texels of its map
/// that overflowed, its rank in the wrong comparison (the first of `setups` and `others`) and in the corrected one (the
/// second and `others`), and a grid of pictures in inputs.out. Requires inputs.renderer. Throws Error(kOutput).
/// Cost: one traced view, kept in inputs.cache.
Exhibit replay(const AxisInputs& inputs, const Mistake& mistake, const std::string& id);

}  // namespace shadowbench::stress
