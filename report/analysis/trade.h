#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "report/analysis/cells.h"
#include "report/analysis/measures.h"

namespace shadowbench::analysis {

/// What may be compared on one front: all cells of one scene, view and picture size, or all scenes and views
/// together. Map format, bias, light and range rule are the same throughout; maps and fits compete, as in advise().
struct TradeScope {
  std::string id;                             ///< fit for a file name, and unique
  std::string title;                          ///< "cubes · view main · 480 × 270"
  bool is_joint = false;                      ///< all scenes together
  std::vector<Configuration> configurations;  ///< never empty; of one cell each, or of one per scene and view
};

/// Sorts a run's cells into scopes: scenes together first, where there are several, then each scene by itself in the
/// order in which it appears. Scenes together hold only configurations that every scene and
/// view has, and leave out what list_left_out() does. Requires that the cells outlive what is returned.
std::vector<TradeScope> make_trade_scopes(const std::vector<records::CellRecord>& cells);
std::vector<TradeScope> make_trade_scopes(std::vector<records::CellRecord>&&) = delete;

/// Reads an error or a cost of a configuration, as the measure combines scenes. Suspect cells have none.
Measured measure(const Configuration& configuration, const Quantity& quantity);

/// A configuration in the plane of the trade; less is better in both.
struct FrontPoint {
  const Configuration* configuration = nullptr;
  Estimate error;
  Estimate cost;
  /// The class of its kernel: a wider one is a softer shadow, not a worse filter. Empty: it is compared with nothing.
  std::optional<std::size_t> group = {};
};

/// Makes the points of a scope for one error and one cost, of what has both.
std::vector<FrontPoint> list_points(const TradeScope& scope, const Quantity& error, const Quantity& cost);

/// Finds each class's Pareto front, by the values as advise() does: taken cheapest first, each must have a smaller
/// error than all before it. Gives for each point the cheapest member that is as good, itself for a member and for what
/// has no class.
std::vector<std::size_t> find_front(const std::vector<FrontPoint>& points);

/// Does neither error nor cost tell two points of a class apart?
bool is_tied(const FrontPoint& a, const FrontPoint& b);

/// Is there a scope in which three cells or more have an error and a cost? Below that there is no trade to show.
bool has_trade(const std::vector<TradeScope>& scopes, const std::vector<Quantity>& costs);

/// Lists the run's filters in order of first appearance: a filter's place gives its colour and mark in all plots.
std::vector<std::string> list_filters(const std::vector<records::CellRecord>& cells);

/// The cost of a frame for a kernel of one width.
struct CurvePoint {
  double sigma_texels = 0.0;
  std::array<Estimate, 2> costs;  ///< kMovingCost and kStaticCost
};

/// The configurations of one filter that differ in nothing but the width of their kernel and the parameters that it
/// follows from: those whose value changes exactly with the width.
struct CostCurve {
  std::string filter;
  std::string label;               ///< with the parameters that tell it from the filter's other curves
  std::vector<CurvePoint> points;  ///< ascending
  bool prefiltered = false;        ///< blurs the map beforehand: cost.prefilter_texels > 0
};

/// The curves of one scene, view, map size, fit and picture size.
struct CostChart {
  std::string id;     ///< "cubes.main.480x270.map512"
  std::string title;  ///< "cubes · view main · 480 × 270 · map 512"
  std::vector<CostCurve> curves;

  /// Lists the widths of its curves, ascending.
  std::vector<double> widths() const;
};

/// Makes charts over the width, of what has both `costs`. Those in which no filter has several widths are left out.
std::vector<CostChart> make_width_charts(const std::vector<TradeScope>& scopes, const std::vector<Quantity>& costs);

}  // namespace shadowbench::analysis
