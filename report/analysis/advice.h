#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "report/analysis/configuration.h"
#include "report/analysis/front.h"
#include "report/analysis/limits.h"
#include "report/analysis/place_state.h"
#include "report/records/records.h"

namespace shadowbench::analysis {

/// What is looked for.
struct AdviceRequest {
  std::vector<Demand> demands;
  LightMotion light = LightMotion::kMoving;
  CostKind cheapest = CostKind::kTime;
  std::vector<std::string> scenes;          ///< empty: all of the run
  std::string width_class;                  ///< of the kernel; empty: any
  std::optional<std::pair<int, int>> size;  ///< of the picture, pixels; empty: all of the run
  bool whole = false;                       ///< keep those that are beaten or no gain, too
  std::set<std::string> known_claims;       ///< that filters make which the run may lack: to require one is no mistake
};

/// How a configuration stands to one demand.
struct Verdict {
  bool kept = false;
  std::optional<double> worst = {};            ///< over the places; empty for a claim
  const records::CellRecord* where = nullptr;  ///< the cell with the worst value
  /// Cells that have nothing on which the limit could be broken; it counts as kept there.
  std::vector<const records::CellRecord*> nothing_to_see = {};
  /// A cell that keeps a limit on the RMSE by less than the RMSE is uncertain; null: there is none.
  const records::CellRecord* uncertain = nullptr;
  std::string absent = {};  ///< why it cannot be judged; empty where it can
};

/// Judges a configuration by a limit, on its cells, which are of `places`.
Verdict judge_limit(const Configuration& configuration, const Demand& demand, LightMotion light,
                    const std::vector<Place>& places);

/// A cost over all places: mean_over_scenes() with each place's quartiles, and with its interval, as frame_time()
/// gives it.
struct Cost {
  double mean = 0.0;
  records::Interval quartiles;            ///< of all but times: the mean twice
  std::optional<records::Interval> ci95;  ///< of times alone; empty where a place has none
};

/// The worst seam between cascades; 0 where there is none.
double find_seam(const std::vector<const records::CellRecord*>& cells);

/// Measures what a configuration costs over `cells`, which are one or more; nothing where a cell has no value.
std::optional<Cost> measure_cost(const std::vector<const records::CellRecord*>& cells, const CostKind& kind,
                                 LightMotion light);

/// A configuration that was judged.
struct Candidate {
  Configuration configuration;
  Cost cost;
  std::vector<Verdict> verdicts;  ///< one per demand
  std::optional<Estimate> rmse;   ///< over the places; empty where none of the run has one everywhere
  double seam = 0.0;              ///< the worst between cascades; 0 where there is none
  bool gains = false;             ///< its RMSE is clearly less than that of the cheapest without a filter
};

/// Does `a` beat `b`: is it no dearer, no more wrong and without a larger seam, and less of one of the first two? By
/// the means alone, so that what is beaten by something that is beaten is beaten too.
bool beats(const Candidate& a, const Candidate& b);

/// Whether a limit is set on an error or on a fault that people see.
bool limits_what_is_seen(const AdviceRequest& request);

/// A configuration that cannot be said to keep the limits.
struct Unjudged {
  Configuration configuration;
  std::string reason;
  std::optional<std::size_t> demand;  ///< the first one that has no value
};

/// Which spread decided whether two costs differ.
enum class Basis {
  kExact,      ///< all but times have none
  kInterval,   ///< 95 % intervals, measured under the same circumstances
  kQuartiles,  ///< of the times, where circumstances differ or there is no interval
};

/// How much more one configuration costs than another.
struct CostGap {
  double difference = 0.0;  ///< of the means, 0 or more
  double share = 0.0;       ///< of the cheaper one's mean; 0 where that is 0
  bool tied = false;        ///< the intervals overlap, or exact costs are equal
  Basis basis = Basis::kExact;
};

/// Compares two costs. Requires that the mean of `cheaper` is not above that of `dearer`.
CostGap compare_costs(const Candidate& cheaper, const Candidate& dearer, const CostKind& kind);

/// How far one demand is in the way. Indices are into Advice::failing.
struct Obstacle {
  std::size_t failing = 0;         ///< judged configurations that fail it
  std::size_t unknown = 0;         ///< configurations that have no value for it
  std::vector<std::size_t> alone;  ///< those that fail it alone, the one that fails it by the least first
  std::vector<std::size_t> buys;   ///< of these, those that cost less than the advised one and all before them
};

/// What can be said about a choice.
struct Advice {
  AdviceRequest request;
  std::vector<Place> places;
  std::set<std::string> teaching;      ///< filters of the run that show a mistake, and are left out
  std::vector<LeftOutPlace> left_out;  ///< not tested, or the choice does not matter there
  std::string unfiltered;          ///< the cheapest configuration without a filter, by its name; empty: none is judged
  std::vector<Candidate> keeping;  ///< all demands, unbeaten, cheapest first: the first is advised
  std::vector<Candidate> beaten;   ///< keep all demands, but one that does so too beats them; cheapest first
  std::vector<Candidate> no_gain;  ///< unbeaten, but no better than unfiltered, where nothing that is seen is limited
  std::vector<Candidate> failing;  ///< cheapest first
  std::vector<Unjudged> unjudged;
  std::vector<Obstacle> obstacles;     ///< one per demand
  std::optional<std::size_t> closest;  ///< index into `failing`: fails the fewest demands, among those by the least
};

/// Finds the configurations that keep every demand in every place, the worst place deciding, and that no other which
/// does so beats: the Pareto front of cost, RMSE and seam over all filters, `none` among them, maps and fits. The
/// cheapest of them is advised. Where nothing that is seen is limited, they must be clearly better than the cheapest
/// configuration without a filter, unless none is: that stands in for the limit that is missing.
///
/// Costs that are equal are ordered by RMSE, then time. Filters for teaching are left out, and with a class of width
/// those of others. A configuration that was not measured in a place, did not finish there, or lacks a value there is
/// not judged; nor is one without an RMSE, where others have one. A value that has nothing to be measured on in some
/// places, as has_nothing_to_see() says, is judged on the others, if there are any. Requires that `cells` outlive what
/// is returned. Throws Error(kUsage) for a scene, class, picture size or GPU that the run does not have, or a claim
/// that no filter makes; Error(kInput) where there is no cell.
Advice advise(const std::vector<records::CellRecord>& cells, const AdviceRequest& request);

}  // namespace shadowbench::analysis
