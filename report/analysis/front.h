#pragma once

#include <cstddef>
#include <optional>
#include <vector>

namespace shadowbench::analysis {

/// A value with the ends of its interval; both ends equal the value where it is exact.
struct Estimate {
  double value = 0.0;
  double low = 0.0;
  double high = 0.0;
  /// What each group of phases found: `value` is about their mean. Two estimates of as many groups were made of the
  /// same phases, and differ by less than each is uncertain. Empty: there are none.
  std::vector<double> replicates = {};
};

/// How much one error is above another, with the 95 % interval of the difference: of that of each group of phases,
/// where both have as many; else it reaches as far as the larger half-width of the two.
Estimate subtract(const Estimate& a, const Estimate& b);

/// One cell in the plane of the trade; less is better in both.
struct FrontPoint {
  Estimate error;
  Estimate cost;
  std::optional<std::size_t> group = 0;  ///< cells of one group are compared with each other alone; empty: with none
};

/// How a cell stands to the front.
enum class Standing {
  kFront,      ///< no cell of the front dominates it or is tied with it
  kTied,       ///< a cell of the front differs from it in neither error nor cost
  kDominated,  ///< a cell of the front beats it
  kApart,      ///< it belongs to no group, and is compared with nothing
};

/// A cell's place: `by` is the cell of the front that it is tied with or dominated by, itself where there is none.
struct Placement {
  Standing standing = Standing::kFront;
  std::size_t by = 0;
};

/// Whether one error is smaller than another by more than is uncertain: the interval of subtract() is above 0. Exact
/// errors differ where they are not equal.
bool is_clearly_less_error(const Estimate& a, const Estimate& b);

/// One cost below another, their intervals not touching?
bool is_clearly_less_cost(const Estimate& a, const Estimate& b);

/// Does `a` beat `b` of its group: its cost is no higher, its error is not clearly larger, and one of the two is
/// clearly less? Costs are compared by their values, because each has an interval of its own: a badly timed cell must
/// not beat others by being uncertain. Errors of one scene share their uncertainty, so that a gain within it is no
/// gain.
bool dominates(const FrontPoint& a, const FrontPoint& b);

/// Does neither error nor cost tell two cells of a group apart?
bool is_tied(const FrontPoint& a, const FrontPoint& b);

/// Finds each group's Pareto front and every other cell's place; entry i is of point i.
///
/// Cells are taken cheapest first; each joins the front unless a member dominates it or is tied with it. Of members
/// that dominate it the cheapest is named, and failing that of those that are tied with it. Ties are therefore always
/// with a member, never with a cell that is itself only tied, so that no chain of small steps joins cells that are far
/// apart. Being tied is not transitive: two cells tied with one member may differ. Cost: cells times members.
std::vector<Placement> find_front(const std::vector<FrontPoint>& points);

/// Lists the fronts' members, group by group, within one the cheapest first.
std::vector<std::size_t> list_members(const std::vector<FrontPoint>& points, const std::vector<Placement>& placements);

}  // namespace shadowbench::analysis
