#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "report/analysis/front.h"
#include "report/analysis/trade.h"

namespace shadowbench::analysis {

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
  std::vector<Measure> costs;  ///< of its scope
  std::vector<CostCurve> curves;

  /// Lists the widths of its curves, ascending.
  std::vector<double> widths() const;
};

/// Sorts cells into charts over the width, whose curves are those of list_width_series(). Charts in which no filter has
/// several widths are left out.
std::vector<CostChart> make_width_charts(const std::vector<records::CellRecord>& cells,
                                         const std::vector<TradeScope>& scopes);

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
Measure make_map_measure(const std::vector<const records::CellRecord*>& cells);

/// Lists the families with maps of several fits; of several the first is that of all filters, with the maps that all
/// have. Suspect cells, and those without error, bytes or time, are left out.
std::vector<MapFamily> list_map_families(const std::vector<const records::CellRecord*>& cells);

/// Says in one sentence which map has the least error at each number of bytes that maps of several fits have, and what
/// the best of every other fit has at the most. Of maps whose errors are tied it is that with the least seam, or none.
/// Empty
/// where no two fits have maps of as many bytes.
std::string describe_best_map(const std::vector<MapFamily>& families);

}  // namespace shadowbench::analysis
