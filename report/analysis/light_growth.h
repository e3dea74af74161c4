#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "report/analysis/crossover.h"
#include "report/analysis/trade.h"
#include "report/records/text_table.h"

namespace shadowbench::analysis {

/// What a frame costs under one number of lights.
struct LightPoint {
  int count = 0;
  Estimate still;         ///< ms: a lookup per light
  Estimate moving;        ///< ms: a depth map, a prefilter and a lookup per light
  Estimate still_spread;  ///< the same as the filter's own median and quartiles: what may be compared between counts
  Estimate moving_spread;
  std::int64_t maps_bytes = 0;
};

/// One filter over the number of lights, all else being equal.
struct LightCurve {
  std::string filter;
  std::string label;               ///< with the parameters that tell it from the filter's other curves
  std::vector<LightPoint> points;  ///< by ascending count
};

/// What one scene, view, map and picture size say of time over the number of lights.
struct LightChart {
  std::string scope_id;
  std::string title;  ///< "cubes · view main · 480 × 270 · map 512"
  std::string scene;
  std::string view;
  int map_size = 0;
  int width = 0;
  int height = 0;
  std::vector<int> counts;  ///< of all curves, ascending
  std::vector<LightCurve> curves;
};

/// How a curve grows, fitted to the filter's own medians. The intervals are what a time anywhere within its
/// quartiles would allow: they are wide where times are unsteady.
struct LightGrowth {
  Estimate per_light_ms;  ///< slope of the time over the count, by least squares
  Estimate exponent;      ///< p of time ~ count^p; see fit_exponent()
  std::optional<double>
      off_line;  ///< the largest distance of a median from that line, as its share; of 3 counts or more
};

/// Compares two curves at the counts that both have. Signs: -1 `a` is cheaper, 1 it is dearer, 0 their intervals
/// overlap.
struct LightComparison {
  std::size_t a = 0;  ///< indices into the chart's curves
  std::size_t b = 0;
  std::vector<int> counts;
  std::vector<int> still;  ///< at each count
  std::vector<int> moving;

  /// Whether each of the two is cheaper at some count.
  bool changes() const;
  /// Whether their intervals are apart at some count.
  bool is_apart() const;
};

/// Sorts the cells whose frames under several lights were timed into charts. Times are per-round ratios to the chart's
/// reference under as many lights, times its median, with the ratio's 95 % interval, as in read_cost(); where the run
/// does not hold the reference, medians and quartiles.
std::vector<LightChart> make_light_charts(const std::vector<records::CellRecord>& cells,
                                          const std::vector<TradeScope>& scopes);

/// The time of a frame.
const Estimate& frame_time(const LightPoint& point, LightState light);

/// Requires two points or more, all times positive.
LightGrowth find_light_growth(const LightCurve& curve, LightState light);

/// Compares all pairs of a chart's curves that have a count in common.
std::vector<LightComparison> compare_light_curves(const LightChart& chart);

/// Write an estimate for people, with its interval where it has one: "3.9 [3.8, 4.1]".
std::string format_time(const Estimate& time);
std::string format_exponent(const Estimate& exponent);

/// Makes the table of a chart, two rows per curve, for casters that stand still and that move.
records::TextTable make_light_table(const LightChart& chart);

/// What each further light costs every filter, in every scene and under each of its lights, and how near to linear that
/// is; nothing for charts of one count.
std::vector<std::string> describe_light_growth(const std::vector<LightChart>& charts, const records::GlRecord& gl);

/// Which filters overtake another between numbers of lights, or between casters that stand still and that move,
/// with the places where they do, and of each chart how many pairs keep their order.
std::vector<std::string> describe_light_order(const std::vector<LightChart>& charts);

}  // namespace shadowbench::analysis
