#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "report/analysis/front.h"
#include "report/analysis/trade.h"

namespace shadowbench::analysis {

/// What a frame costs at one kernel width, as the chart's measures have it: milliseconds, or a ratio to `none`.
struct WidthPoint {
  double sigma_texels = 0.0;
  Estimate still;   ///< the lookup alone
  Estimate moving;  ///< map, prefilter and lookup
};

/// One filter over its kernel width, all else being equal.
struct WidthCurve {
  std::string filter;
  std::string label;               ///< with the parameters that tell it from the filter's other curves
  bool prefiltered = false;        ///< blurs the map beforehand: cost.prefilter_texels > 0
  bool many_taps = false;          ///< not prefiltered, and reads the map more than once per receiver
  std::vector<WidthPoint> points;  ///< narrow before wide
};

/// What one scene, view, map and picture size say of time over the kernel's width.
struct WidthChart {
  std::string scope_id;
  std::string title;  ///< "cubes · view main · 480 × 270 · map 512"
  std::string scene;
  std::string view;
  int map_size = 0;
  int width = 0;
  int height = 0;
  std::vector<WidthCurve> curves;
  std::vector<Measure> costs;  ///< those of its scope: what the curves' values are
};

/// Which passes are paid in a frame.
enum class LightState { kStill, kMoving };

/// Compares a prefiltered curve with one that reads many taps, at the widths that both cover.
///
/// A width counts where one of the curves was measured and the other was measured there, or on both sides of it, where
/// its time is interpolated, its logarithm linearly over the width. Widths that differ by up to 1 % are taken for one.
/// Cheaper and dearer are said where the intervals do not overlap.
struct CurveComparison {
  std::size_t prefiltered = 0;  ///< index into the chart's curves
  std::size_t taps = 0;         ///< likewise
  LightState light = LightState::kStill;
  std::vector<double> widths;         ///< ascending; none where the curves have no width in common
  std::vector<int> signs;             ///< at each: -1 prefiltered is cheaper, 0 not apart, 1 it is dearer
  std::vector<WidthPoint> crossings;  ///< interpolated, where both medians are the same time
};

/// Sorts cells into charts, whose curves are those of list_width_series(). Charts without a prefiltered curve or
/// without one of many taps are left out.
std::vector<WidthChart> make_width_charts(const std::vector<records::CellRecord>& cells,
                                          const std::vector<TradeScope>& scopes);

/// A curve's time at a width: measured or interpolated; nothing outside the widths measured.
std::optional<Estimate> time_at(const WidthCurve& curve, double sigma_texels, LightState light);

/// Compares all pairs of a chart that have a width in common.
std::vector<CurveComparison> compare_curves(const WidthChart& chart, LightState light);

/// Where the prefiltered curve is cheaper, to follow "is cheaper": "from a kernel width of 4 texels on, of 2, 4
/// compared".
std::string describe_comparison(const CurveComparison& comparison);

/// Says in plain sentences from which kernel width on prefiltered maps beat filters that read many taps, where the
/// cells support it; one sentence per pair of curves and state of the light, with the places where it holds.
std::vector<std::string> describe_crossovers(const std::vector<WidthChart>& charts);

}  // namespace shadowbench::analysis
