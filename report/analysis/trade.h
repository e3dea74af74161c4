#pragma once

#include <array>
#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "report/analysis/cells.h"
#include "report/analysis/measures.h"
#include "report/records/records.h"

namespace shadowbench::analysis {

/// A filter with its parameters and a map size, and what it got and paid in one scope.
struct TradeConfiguration {
  std::string filter;
  records::ParamMap params;  ///< as they were asked for
  int map_size = 0;
  std::optional<double> sigma_texels;      ///< width of its kernel; none where that differs between scenes
  std::optional<std::size_t> width_class;  ///< see find_class()
  std::string label;                       ///< tells it apart in its scope: "vsm (radius 4), map 512"
  CellList cells;                          ///< of the run: one, or one per scene and view
  std::array<Measured, kErrorMeasures> errors;
  std::vector<Measured> costs;  ///< one for each of the scope's
};

/// What may be compared on one front: all cells of one scene, view and picture size, or all scenes and views
/// together. Map format, bias, fit, light and range rule are the same throughout.
struct TradeScope {
  std::string id;     ///< fit for a file name, and unique
  std::string title;  ///< "cubes · view main · 480 × 270"
  std::string scene;  ///< empty for all scenes together
  std::string view;
  int width = 0;
  int height = 0;
  std::vector<Quantity> costs;  ///< those that the run has: list_cost_measures() of its cells
  std::vector<TradeConfiguration> configurations;
  std::size_t incomplete = 0;  ///< configurations left out because not every scene and view has a cell of them
};

/// Sorts a run's cells into scopes: scenes together first, where there are several, then each scene by itself in the
/// order in which it appears. Scenes together hold only configurations that every scene and
/// view has, and leave out what list_left_out() does. Requires that the cells outlive what is returned.
std::vector<TradeScope> make_trade_scopes(const std::vector<records::CellRecord>& cells);

/// The configurations of one filter that differ in nothing but the width of their kernel and the parameters that it
/// follows from: those whose value changes exactly with the width.
struct WidthSeries {
  std::string filter;
  std::string label;                        ///< with the parameters that tell it from the filter's other series
  std::vector<std::size_t> configurations;  ///< indices, narrow before wide
};

/// Sorts those of `configurations` that `chosen` holds into series, in the order in which each first appears. Each map
/// size has its own; configurations whose kernel's width is unknown are left out.
std::vector<WidthSeries> list_width_series(const std::vector<TradeConfiguration>& configurations,
                                           const std::vector<std::size_t>& chosen);

/// The front of a scope for one error and one cost.
struct TradeFront {
  std::size_t error = 0;                    ///< index into list_error_measures()
  std::size_t cost = 0;                     ///< index into the scope's costs
  std::vector<std::size_t> configurations;  ///< those that have both, indices into the scope's
  std::vector<FrontPoint> points;           ///< entry i is of configurations[i]
  std::vector<Placement> placements;        ///< likewise; `by` is an index into `points`
  std::vector<std::size_t> members;  ///< indices into `points`; by group, that is class of width, then cheapest first
  std::map<std::string, int> left_out;  ///< reason to number of configurations without one of the two
};

/// Finds the front of a scope: one of each class of width, for a wider kernel is a softer shadow, not a worse filter.
TradeFront make_trade_front(const TradeScope& scope, std::size_t error, std::size_t cost);

/// Is there a scope in which three cells or more have an error and a cost? Below that there is no trade to show.
bool has_trade(const std::vector<TradeScope>& scopes);

/// Lists the run's filters in order of first appearance: a filter's place gives its colour and mark in all plots.
std::vector<std::string> list_filters(const std::vector<records::CellRecord>& cells);

/// The cost of a frame for a kernel of one width.
struct CurvePoint {
  double sigma_texels = 0.0;
  std::array<Estimate, 2> costs;  ///< kMovingCost and kStaticCost
};

/// One filter over the kernel's width, all else being equal.
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
  std::vector<Quantity> costs;  ///< of its scope
  std::vector<CostCurve> curves;

  /// Lists the widths of its curves, ascending.
  std::vector<double> widths() const;
};

/// Sorts cells into charts over the width, whose curves are those of list_width_series(). Charts in which no filter has
/// several widths are left out.
std::vector<CostChart> make_width_charts(const std::vector<TradeScope>& scopes);

/// What a filter got and paid with one map, in a frame that draws the map.
struct MapPoint {
  std::string kind;  ///< of its fit: "cascades"
  std::string name;  ///< of its fit: "4 cascades, split 0.8"
  int size = 0;      ///< texels along a side
  double bytes = 0.0;
  Estimate cost, rmse;
  std::optional<double> seam;  ///< between cascades
};

/// The maps of one filter in one scene and view, all else being equal; or of all filters everywhere: least bytes, mean
/// cost, root mean square of errors, worst seam.
struct MapFamily {
  std::string title;           ///< "vsm (radius 4) on cubes"
  std::vector<MapPoint> maps;  ///< by ascending bytes
};

/// The cost of map families: time of map, prefilter and filter.
Quantity make_map_measure(const std::vector<const records::CellRecord*>& cells);

/// Lists the families with maps of several fits; of several the first is that of all filters, with the maps that all
/// have. Suspect cells, and those without error, bytes or time, are left out.
std::vector<MapFamily> list_map_families(const std::vector<const records::CellRecord*>& cells);

}  // namespace shadowbench::analysis
