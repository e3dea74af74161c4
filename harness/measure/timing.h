#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "harness/gl/survey.h"
#include "harness/options/options.h"
#include "harness/render/filter_passes.h"
#include "report/records/records.h"

namespace shadowbench::measure {

/// Gives median and quartiles, linearly interpolated between order statistics (Hyndman and Fan 1996, type 7).
/// Requires at least one value.
records::Quartiles summarise(std::vector<double> values);

/// The median of the paired ratios numerator[i] / denominator[i] with its 95 % interval, between order statistics
/// (Hettmansperger and Sheather 1986, Confidence Intervals Based on Interpolated Order Statistics, Statistics and
/// Probability Letters 4(2)); of fewer than six ratios by Student's t, and of one the ratio itself. Requires at least
/// one numerator; of more denominators the first are used. Cost: microseconds.
records::Ratio find_ratio(const std::vector<double>& numerator, const std::vector<double>& denominator);

/// The spread of the paired differences minuend[i] - subtrahend[i] with the same interval of their median. Requires at
/// least one minuend; of more subtrahends the first are used.
records::OwnTime find_difference(const std::vector<double>& minuend, const std::vector<double>& subtrahend);

/// Why no more rounds were timed.
enum class StopReason {
  kRounds,   ///< as many as were asked for, or as there may be
  kPrecise,  ///< the ratio's interval is as narrow as was asked for
  kBudget,   ///< the time is spent
};
constexpr auto names_of(StopReason) { return std::array{"rounds", "precise", "budget"}; }

/// Times of one filter, one entry per round it took part in, from the first on; milliseconds.
struct FilterTimes {
  std::vector<double> prefilter;  ///< empty for filters that read depth
  std::vector<double> lookup;     ///< screen passes included
  std::vector<double> screen;     ///< these alone; empty for filters without
  StopReason stopped = StopReason::kRounds;
};

/// Times of a set of filters that took turns; entry i of every list comes from round i.
struct RoundTimes {
  std::vector<double> map;                   ///< of every round, and of more until its interval is 10 % wide
  std::vector<FilterTimes> filters;          ///< in the order given
  std::vector<std::vector<double>> empties;  ///< of lookups that read nothing of the map, in the order given
  double spent_ms = 0.0;                     ///< of all passes, those that warm up included
};

/// Runs one filter's passes once and gives their times in milliseconds.
struct TimedFilter {
  std::function<double()> prefilter;  ///< empty for filters that read depth
  std::function<double()> lookup;
  std::function<double()> screen = {};  ///< empty for filters without screen passes
};

/// What takes turns in timed rounds; each gives its time in milliseconds.
struct TimedPasses {
  std::vector<TimedFilter> filters = {};
  std::function<double()> draw_map = {};
  std::vector<std::function<double()>> empties = {};  ///< take part in every round
};

/// How long rounds go on, and by what they are judged.
struct RoundPlan {
  std::size_t reference = 0;  ///< index of the filter that ratios refer to
  options::RoundLimits limits = {};
  std::uint64_t seed = 1;
  double drawn_ms = 0.0;  ///< what running every filter once has cost before
};

/// Times interleaved rounds: every round draws the map and runs each filter once, in a shuffled order, so that drift of
/// the machine's speed hits all alike. After a prefilter three lookups go untimed, and the fourth is timed: a CPU's are
/// up to 1.6 times as slow at first. One round warms up, unless `drawn_ms` spends the budget already. A filter drops
/// out when its ratios to the reference, of the lookup and of all passes, are precise enough. When the budget is spent,
/// all stop, but not before three rounds, or one where no more may be. Requires at least one filter.
RoundTimes run_rounds(const TimedPasses& passes, const RoundPlan& plan);

/// Runs a filter's passes once, into `target`, and gives their time in milliseconds.
double time_once(render::FilterPasses& filter, const render::ShadowMap& map, const render::GBuffer& gbuffer,
                 render::ImageTarget& target, gl::TimerKind timer);

/// Filters that were drawn once over a map and a view, and empty lookups.
struct DrawnFilters {
  std::span<render::FilterPasses* const> filters;
  std::span<const std::unique_ptr<render::FilterPasses>> empties = {};
  std::function<void()> draw_map = [] {};
  const render::ShadowMap& map;
  const render::GBuffer& gbuffer;
  gl::TimerKind timer = gl::TimerKind::kWallClock;
};

/// Times the shadow map, prefilters and lookups, as run_rounds().
RoundTimes time_rounds(const DrawnFilters& drawn, const RoundPlan& plan);

/// Adds what a filter costs in a frame in which light or casters move: map, prefilter and lookup, round by round.
std::vector<double> add_moving(const std::vector<double>& map, const FilterTimes& times);

/// Indices into RoundTimes: a filter, the one that ratios refer to, and the filter's empty lookup.
struct TimedCell {
  std::size_t filter = 0;
  std::size_t reference = 0;
  std::size_t empty = 0;
};

/// Notes what a cell costs: the medians of its passes, and its own times under a static and a moving light.
void note_times(records::CellRecord& record, const RoundTimes& rounds, const TimedCell& cell);

}  // namespace shadowbench::measure
