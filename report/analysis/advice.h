#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "report/analysis/cells.h"
#include "report/analysis/measures.h"
#include "report/records/records.h"

namespace shadowbench::analysis {

/// Says why a configuration's cells do not show contact hardening, which the growth of penumbrae decides; empty where
/// they do. Every place that can show it must; a place that cannot says nothing.
std::string find_doubt(const std::vector<const records::CellRecord*>& cells);

/// Whether a configuration's filter claims contact hardening, and shows it.
bool hardens(const std::vector<const records::CellRecord*>& cells);

/// What is looked for.
struct AdviceRequest {
  std::vector<Demand> demands = {};
  LightMotion light = LightMotion::kMoving;
  CostKind cheapest = CostKind::kTime;
  std::vector<std::string> scenes = {};          ///< empty: all of the run
  std::string width_class = {};                  ///< of the kernel; empty: any
  std::optional<std::pair<int, int>> size = {};  ///< of the picture, pixels; empty: all of the run
  bool whole = false;                            ///< keep those that are beaten or no gain, too
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

/// Whether a limit is set on an error or on a fault that people see.
bool limits_what_is_seen(const AdviceRequest& request);

/// A configuration that cannot be said to keep the limits.
struct Unjudged {
  Configuration configuration;
  std::string reason;
};

/// Whether two costs are the same, or their intervals overlap: the 95 % intervals of times that were measured under the
/// same circumstances, else their quartiles. Requires that the mean of `cheaper` is not above that of `dearer`.
bool are_costs_tied(const Candidate& cheaper, const Candidate& dearer, const CostKind& kind);

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
  std::vector<Candidate> failing;  ///< nearest first: fails the fewest demands, among those by the least
  std::vector<Unjudged> unjudged;
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
/// is returned. Throws Error(kUsage) for a scene, class, picture size or GPU that the run does not have;
/// Error(kInput) where there is no cell.
Advice advise(const std::vector<records::CellRecord>& cells, const AdviceRequest& request);

/// A seam from here on is seen: a step of brightness of 2 %, about Weber's fraction of the eye.
inline constexpr double kVisibleSeam = 0.02;

/// An RMSE that is tied with the least is no best one where it is larger than this many times that: too few phases
/// tell.
inline constexpr double kMostOfTie = 1.1;

/// What an answer may be called, the cheapest first.
inline constexpr const char *kFast = "fast", *kBalanced = "balanced", *kBest = "best";

/// One of the answers that a reader chooses from.
struct Pick {
  std::vector<std::string> names;  ///< of those above: one, or fast and best
  std::size_t index = 0;           ///< into Advice::keeping
  std::string why;
};

/// Lists them, the cheapest first; none is beaten by a candidate that keeps the demands. *Fast* is the first that is
/// advised. *Best* is the cheapest whose RMSE over the places is not clearly above the least; there is none where no
/// RMSE is known, or that RMSE is more than a tenth above the least all the same, as too few phases tell. *Balanced*
/// is, of those between the two, the one furthest below the straight line from fast to best in the plane of cost and
/// RMSE (the knee; Satopaa et al. 2011, Finding a "Kneedle" in a Haystack); its RMSE is clearly less than that of the
/// fast one, and its cost clearly less than that of the best. Costs that cannot be compared leave it out. Where the
/// cost and RMSE of another cannot be told from a pick's, that with the smaller seam between cascades is picked; a seam
/// that is seen is said. Requires one that keeps the demands.
std::vector<Pick> list_picks(const Advice& advice);

/// The sentences of an answer, by name, with names and numbers in braces; a page's script fills the same.
const std::map<std::string, std::string>& answer_words();

/// Says in a sentence which filter to use, and which where shadows must look right. Requires one that keeps the
/// demands.
std::string describe_choice(const Advice& advice);

}  // namespace shadowbench::analysis
