#pragma once

#include <array>
#include <string>
#include <vector>

#include "report/analysis/front.h"
#include "report/analysis/trade.h"

namespace shadowbench::analysis {

/// What a curve runs over: the kernel's width in texels, or the number of lights.
enum class CurveAxis { kWidth, kLights };

/// The cost of a frame at one place of the axis: of width as in the scope's costs, of lights in milliseconds.
struct CurvePoint {
  double at = 0.0;
  std::array<Estimate, 2> costs;  ///< kMovingCost and kStaticCost
};

/// One filter over the axis, all else being equal.
struct CostCurve {
  std::string filter;
  std::string label;               ///< with the parameters that tell it from the filter's other curves
  std::vector<CurvePoint> points;  ///< ascending
  bool prefiltered = false;        ///< blurs the map beforehand: cost.prefilter_texels > 0
};

/// The curves of one scene, view, map size and picture size.
struct CostChart {
  std::string scope_id;
  std::string title;  ///< "cubes · view main · 480 × 270 · map 512"
  int map_size = 0;
  CurveAxis axis = CurveAxis::kWidth;
  std::vector<Measure> costs;  ///< those of its scope: what the curves over the width are in
  std::vector<CostCurve> curves;

  /// Lists where its curves were measured, ascending.
  std::vector<double> places() const;
};

/// Sorts cells into charts over the width, whose curves are those of list_width_series(). Charts in which no filter has
/// several widths are left out.
std::vector<CostChart> make_width_charts(const std::vector<records::CellRecord>& cells,
                                         const std::vector<TradeScope>& scopes);

/// Sorts the cells whose frames under several lights were timed into charts. Times are per-round ratios to the chart's
/// reference under as many lights, times its median, with the ratio's 95 % interval; where the run does not hold the
/// reference, medians and quartiles.
std::vector<CostChart> make_light_charts(const std::vector<records::CellRecord>& cells,
                                         const std::vector<TradeScope>& scopes);

/// What a filter got and paid with one map, in a frame that draws the map.
struct MapPoint {
  std::string fit;
  int size = 0;  ///< texels along a side
  Estimate cost, rmse;
};

/// The maps of one filter in one scene and view, all else being equal.
struct MapFamily {
  std::string title;           ///< "vsm (radius 4) on cubes"
  std::vector<MapPoint> maps;  ///< by ascending size
};

/// The cost of map families: time of map, prefilter and filter.
Measure make_map_measure(const std::vector<records::CellRecord>& cells);

/// Lists the families with maps of several fits. Suspect cells, and those without error or time, are left out.
std::vector<MapFamily> list_map_families(const std::vector<records::CellRecord>& cells);

}  // namespace shadowbench::analysis
