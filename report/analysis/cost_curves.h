#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "report/analysis/front.h"
#include "report/analysis/limits.h"
#include "report/analysis/trade.h"
#include "report/records/text_table.h"

namespace shadowbench::analysis {

/// Something of a frame with a moving light and of one with a static light.
template <class T>
struct PerLight {
  T moving{}, static_light{};

  T& operator[](LightMotion light) { return light == LightMotion::kMoving ? moving : static_light; }
  const T& operator[](LightMotion light) const { return light == LightMotion::kMoving ? moving : static_light; }
};

/// Both, in the order in which tables and charts have them.
inline constexpr LightMotion kBothLights[] = {LightMotion::kStatic, LightMotion::kMoving};

/// What a curve runs over: the kernel's width in texels, or the number of lights.
enum class CurveAxis { kWidth, kLights };

/// What a frame costs at one place of the axis, as the chart's measures have it: milliseconds, or a ratio to `none`.
struct CurvePoint {
  double at = 0.0;
  PerLight<Estimate> cost;
  PerLight<Estimate> spread;  ///< over lights: the filter's own median and quartiles, which compare between numbers
};

/// One filter over the axis, all else being equal.
struct CostCurve {
  std::string filter;
  std::string label;               ///< with the parameters that tell it from the filter's other curves
  std::vector<CurvePoint> points;  ///< ascending
  bool prefiltered = false;        ///< blurs the map beforehand: cost.prefilter_texels > 0
  bool many_taps = false;          ///< not prefiltered, and reads the map more than once per receiver
  std::int64_t maps_bytes = 0;     ///< over lights: of the most of them
};

/// What one scene, view, map and picture size say of a frame's cost over an axis.
struct CostChart {
  std::string scope_id;
  std::string title;  ///< "cubes · view main · 480 × 270 · map 512"
  int map_size = 0;
  CurveAxis axis = CurveAxis::kWidth;
  std::vector<Measure> costs;  ///< those of its scope: what the curves over the width are in
  std::vector<CostCurve> curves;
};

/// How a curve over lights grows, fitted to the filter's own medians. The intervals are what a time anywhere within its
/// quartiles would allow: they are wide where times are unsteady.
struct LightGrowth {
  Estimate per_light_ms;  ///< slope of the time over the count, by least squares
  Estimate exponent;      ///< p of time ~ count^p; see fit_exponent()
  std::optional<double>
      off_line;  ///< the largest distance of a median from that line, as its share; of 3 counts or more
};

/// Compares two curves of a chart.
///
/// A width counts where one of the curves was measured and the other was measured there, or on both sides of it, where
/// its cost is interpolated, its logarithm linearly over the width. Widths that differ by up to 1 % are taken for one.
/// A number of lights counts where both were measured. Cheaper and dearer are said where the intervals do not overlap.
struct CurveComparison {
  std::size_t a = 0, b = 0;          ///< indices into the chart's curves
  std::vector<double> at;            ///< ascending
  PerLight<std::vector<int>> signs;  ///< at each: -1 `a` is cheaper, 0 not apart, 1 it is dearer
  PerLight<std::vector<std::pair<double, double>>> crossings;  ///< interpolated place and cost where medians are equal

  /// Whether `a` has a sign anywhere, with casters static or moving.
  bool has(int sign) const;
  /// Whether each of the two is cheaper somewhere.
  bool changes() const { return has(-1) && has(1); }
};

/// Sorts cells into charts over the width, whose curves are those of list_width_series(). Charts without a prefiltered
/// curve or without one of many taps are left out.
std::vector<CostChart> make_width_charts(const std::vector<records::CellRecord>& cells,
                                         const std::vector<TradeScope>& scopes);

/// Sorts the cells whose frames under several lights were timed into charts. Times are per-round ratios to the chart's
/// reference under as many lights, times its median, with the ratio's 95 % interval, as in read_cost(); where the run
/// does not hold the reference, medians and quartiles.
std::vector<CostChart> make_light_charts(const std::vector<records::CellRecord>& cells,
                                         const std::vector<TradeScope>& scopes);

/// Lists where the charts' curves were measured, ascending; of two places that are taken for one the first.
std::vector<double> list_measured(std::span<const CostChart> charts);

/// A curve's cost at a width: measured or interpolated; nothing outside the widths measured.
std::optional<Estimate> cost_at(const CostCurve& curve, double at, LightMotion light);

/// Compares those curves of a chart that have a place in common: over the width every prefiltered one with every one
/// of many taps, over lights all pairs.
std::vector<CurveComparison> compare_curves(const CostChart& chart);

/// Fits the exponent by least squares in the logarithms of (size, time). Requires two different sizes or more, all
/// positive.
double fit_exponent(std::vector<std::pair<double, double>> points);

/// Requires two points or more, all times positive.
LightGrowth find_light_growth(const CostCurve& curve, LightMotion light);

/// Makes a table of charts over the width, a row for each comparison; of charts over lights, for each whose order
/// changes.
records::TextTable make_comparison_table(const std::vector<CostChart>& charts);

/// Makes the table of charts over lights, two rows per curve, for casters that stand still and that move.
records::TextTable make_light_table(const std::vector<CostChart>& charts);

/// Makes the table of how times (medians) grow with the picture and with the map: a row for each filter, in it the
/// exponents p of time ~ size^p, of each series of cells that differ in the size alone. No columns but the filter's
/// where no cells do.
records::TextTable make_growth_table(const std::vector<records::CellRecord>& cells);

/// Says in a sentence how often, and from which width on, prefiltered maps beat many taps; empty without charts.
std::string summarize_widths(const std::vector<CostChart>& charts);

/// Says in a sentence what a further light costs, and how many pairs change their order; empty where no chart has
/// several numbers of lights.
std::string summarize_lights(const std::vector<CostChart>& charts, const records::GlRecord& gl);

}  // namespace shadowbench::analysis
