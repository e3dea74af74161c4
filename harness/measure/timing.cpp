#include "harness/measure/timing.h"

#include <gsl/gsl_cdf.h>
#include <gsl/gsl_statistics_double.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <iterator>
#include <numbers>
#include <numeric>
#include <random>

#include "reference/metrics/error_stats.h"

namespace shadowbench::measure {
namespace {

constexpr double kConfidence = 0.95;
constexpr std::size_t kFewestOrdered = 6;  // of fewer values, the least and the most hold the median less often

double quantile(const std::vector<double>& sorted, double q) {
  return gsl_stats_quantile_from_sorted_data(sorted.data(), 1, sorted.size(), q);
}

double median_of(std::vector<double> values) {
  std::ranges::sort(values);
  return quantile(values, 0.5);
}

std::vector<double> divide(const std::vector<double>& numerator, const std::vector<double>& denominator) {
  assert(!numerator.empty() && numerator.size() <= denominator.size());
  std::vector<double> ratios(numerator.size());
  for (std::size_t i = 0; i < ratios.size(); ++i) ratios[i] = numerator[i] / denominator[i];
  return ratios;
}

/// Half the width of the interval of a median of fewer values, as of normal ones, whose median is sqrt(pi / 2) as
/// uncertain as their mean; 0 for one.
double find_reach(const std::vector<double>& values) {
  if (values.size() < 2) return 0.0;
  const double t = metrics::find_student_t(values.size(), 0.975);
  return t * std::sqrt(0.5 * std::numbers::pi) * metrics::find_standard_error(values);
}

/// In how many cases of a hundred, as a share, the median lies between the `place`-th smallest and largest of `count`
/// values.
double cover(std::size_t count, std::size_t place) {  // of as many fair coins fewer than `place` show heads, or tails
  return 1.0 - 2.0 * gsl_cdf_binomial_P(static_cast<unsigned>(place - 1), 0.5, static_cast<unsigned>(count));
}

/// The 95 % interval of the median.
records::Interval find_interval(std::vector<double> values) {
  std::ranges::sort(values);
  const std::size_t count = values.size();
  if (count < kFewestOrdered) {
    const double median = quantile(values, 0.5), reach = find_reach(values);
    return {median - reach, median + reach};
  }
  std::size_t place = 1;
  while (cover(count, place + 1) >= kConfidence) ++place;
  const double wide = cover(count, place), narrow = cover(count, place + 1);
  const double n = static_cast<double>(count), d = static_cast<double>(place);
  const double excess = (wide - kConfidence) / (wide - narrow);
  const double inward = (n - d) * excess / (d + (n - 2.0 * d) * excess);
  return {std::lerp(values[place - 1], values[place], inward),
          std::lerp(values[count - place], values[count - place - 1], inward)};
}

constexpr int kFewestOfAnyBudget = 3;
/// Lookups that go untimed after a prefilter: right after it a CPU's are slower.
constexpr int kSettlingLookups = 3;
/// Looks at the intervals again after an eighth more rounds: every look is a chance to stop where one is narrow by
/// chance.
constexpr int kRoundsPerLook = 8;
/// How wide the 95 % interval of the map's time may be, and the rounds that the map gets where it is wider.
constexpr double kMapPrecision = 0.1;
constexpr std::size_t kFewestOfMap = 15;

/// Fisher and Yates; std::shuffle differs between standard libraries.
void shuffle(std::vector<std::size_t>& order, std::mt19937_64& generator) {
  for (std::size_t i = order.size(); i > 1; --i) std::swap(order[i - 1], order[generator() % i]);
}

class Rounds {
 public:
  Rounds(const TimedPasses& passes, const RoundPlan& plan)
      : filters_(passes.filters),
        passes_(passes),
        plan_(plan),
        limits_(plan.limits),
        generator_(plan.seed),
        active_(filters_.size()) {
    assert(!filters_.empty() && plan.reference < filters_.size());
    std::iota(active_.begin(), active_.end(), std::size_t{0});
    times_.filters.resize(filters_.size());
    times_.empties.resize(passes.empties.size());
    times_.spent_ms = plan.drawn_ms;
  }

  RoundTimes run() {
    if (!is_spent()) run_round(false);  // slower passes are warm
    for (int round = 1; round <= limits_.most; ++round) {
      run_round(true);
      if (is_enough(round)) break;
    }
    while (!is_map_timed()) times_.map.push_back(passes_.draw_map());
    return std::move(times_);
  }

 private:
  const std::vector<TimedFilter>& filters_;
  const TimedPasses& passes_;
  const RoundPlan& plan_;
  const options::RoundLimits& limits_;
  std::mt19937_64 generator_;
  std::vector<std::size_t> active_;
  RoundTimes times_;
  int next_look_ = 0;  ///< rounds after which intervals are looked at again

  void run_round(bool counted) {
    const double map_ms = passes_.draw_map();
    times_.spent_ms += map_ms;
    if (counted) times_.map.push_back(map_ms);
    for (const std::size_t i : shuffle_turns()) {
      if (i >= filters_.size()) {
        run_empty(i - filters_.size(), counted);
        continue;
      }
      const double prefilter_ms = filters_[i].prefilter ? filters_[i].prefilter() : 0.0;
      for (int settle = 0; filters_[i].prefilter && settle < kSettlingLookups; ++settle)
        times_.spent_ms += filters_[i].lookup();
      const double reading_ms = filters_[i].lookup();
      const double screen_ms = filters_[i].screen ? filters_[i].screen() : 0.0;
      const double lookup_ms = reading_ms + screen_ms;
      times_.spent_ms += prefilter_ms + lookup_ms;
      if (!counted) continue;
      if (filters_[i].prefilter) times_.filters[i].prefilter.push_back(prefilter_ms);
      if (filters_[i].screen) times_.filters[i].screen.push_back(screen_ms);
      times_.filters[i].lookup.push_back(lookup_ms);
    }
  }

  /// Whether the map's interval is narrow, or the map had its rounds and a filter's budget.
  bool is_map_timed() const {
    const std::size_t rounds = times_.map.size();
    if (limits_.is_fixed() || rounds >= static_cast<std::size_t>(limits_.most)) return true;
    const records::Ratio time = find_ratio(times_.map, std::vector<double>(rounds, 1.0));
    if (time.ci95.high - time.ci95.low <= kMapPrecision * time.median) return true;
    return rounds >= kFewestOfMap && std::accumulate(times_.map.begin(), times_.map.end(), 0.0) >= limits_.budget_ms;
  }

  /// The filters that still take part, and behind them the empty lookups, in an order of this round's own.
  std::vector<std::size_t> shuffle_turns() {
    std::vector<std::size_t> turns = active_;
    for (std::size_t k = 0; k < passes_.empties.size(); ++k) turns.push_back(filters_.size() + k);
    shuffle(turns, generator_);
    return turns;
  }

  void run_empty(std::size_t which, bool counted) {
    const double ms = passes_.empties[which]();
    times_.spent_ms += ms;
    if (counted) times_.empties[which].push_back(ms);
  }

  bool is_spent() const {
    return !limits_.is_fixed() && times_.spent_ms >= limits_.budget_ms * static_cast<double>(filters_.size());
  }

  bool is_enough(int rounds) {
    if (limits_.is_fixed()) return false;
    if (rounds >= std::max(limits_.fewest, next_look_)) {
      drop_precise();
      next_look_ = rounds + 1 + rounds / kRoundsPerLook;
    }
    if (active_.empty()) return true;
    if (rounds < std::min(kFewestOfAnyBudget, limits_.most) || !is_spent()) return false;
    for (const std::size_t i : active_) times_.filters[i].stopped = StopReason::kBudget;
    return true;
  }

  /// The reference is as precise as can be: its ratio to itself is 1.
  void drop_precise() {
    std::erase_if(active_, [&](std::size_t i) {
      if (i == plan_.reference || !is_precise(times_.filters[i])) return false;
      times_.filters[i].stopped = StopReason::kPrecise;
      return true;
    });
    if (active_.size() != 1 || active_.front() != plan_.reference) return;
    times_.filters[plan_.reference].stopped = StopReason::kPrecise;
    active_.clear();
  }

  bool is_precise(const FilterTimes& times) const {
    const FilterTimes& reference = times_.filters[plan_.reference];
    return is_narrow(times.lookup, reference.lookup) &&
           is_narrow(add_moving(times_.map, times), add_moving(times_.map, reference));
  }

  bool is_narrow(const std::vector<double>& numerator, const std::vector<double>& denominator) const {
    const records::Ratio ratio = find_ratio(numerator, denominator);
    return ratio.ci95.high - ratio.ci95.low <= limits_.precision * ratio.median;
  }
};

/// Makes passes that are timed; of no function none is made.
TimedFilter make_timed(gl::TimerKind timer, std::function<void()> prefilter, std::function<void()> lookup,
                       std::function<void()> screen = {}) {
  const auto make = [timer](std::function<void()> pass) -> std::function<double()> {
    if (!pass) return {};
    return [timer, pass = std::move(pass)] { return gl::time_ms(timer, pass); };
  };
  return {make(std::move(prefilter)), make(std::move(lookup)), make(std::move(screen))};
}

}  // namespace

records::Quartiles summarise(std::vector<double> values) {
  assert(!values.empty());
  std::ranges::sort(values);
  return {quantile(values, 0.5), quantile(values, 0.25), quantile(values, 0.75), static_cast<int>(values.size())};
}

records::Ratio find_ratio(const std::vector<double>& numerator, const std::vector<double>& denominator) {
  const std::vector<double> ratios = divide(numerator, denominator);
  const records::Interval interval = find_interval(ratios);
  return {median_of(ratios), {std::max(0.0, interval.low), interval.high}};
}

records::OwnTime find_difference(const std::vector<double>& minuend, const std::vector<double>& subtrahend) {
  assert(minuend.size() <= subtrahend.size());
  std::vector<double> differences;
  std::ranges::transform(minuend, subtrahend, std::back_inserter(differences), std::minus());
  return {summarise(differences), find_interval(differences)};
}

std::vector<double> add_moving(const std::vector<double>& map, const FilterTimes& times) {
  std::vector<double> sum = times.lookup;
  for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += map[i] + (times.prefilter.empty() ? 0.0 : times.prefilter[i]);
  return sum;
}

RoundTimes run_rounds(const TimedPasses& passes, const RoundPlan& plan) { return Rounds(passes, plan).run(); }

double time_once(render::FilterPasses& filter, const render::ShadowMap& map, const render::GBuffer& gbuffer,
                 render::ImageTarget& target, gl::TimerKind timer) {
  return gl::time_ms(
      timer,
      [&] {
        filter.prefilter(map);
        filter.lookup(gbuffer, map, target);
      });
}

RoundTimes time_rounds(const DrawnFilters& drawn, const RoundPlan& plan) {
  render::ImageTarget target("timed visibility", GL_R32F, drawn.gbuffer.width(), drawn.gbuffer.height());
  const auto look_up_by = [&](render::FilterPasses* filter) {
    return [&, filter] { filter->look_up(drawn.gbuffer, drawn.map, target); };
  };
  TimedPasses timed{.draw_map = [&] { return gl::time_ms(drawn.timer, drawn.draw_map); }};
  for (render::FilterPasses* filter : drawn.filters) {
    std::function<void()> prefilter, screen;
    if (filter->has_prefilter()) prefilter = [&, filter] { filter->prefilter(drawn.map); };
    if (filter->has_screen()) screen = [&, filter] { filter->filter_screen(drawn.gbuffer, target); };
    timed.filters.push_back(make_timed(drawn.timer, prefilter, look_up_by(filter), screen));
  }
  for (const auto& empty : drawn.empties)
    timed.empties.push_back(make_timed(drawn.timer, {}, look_up_by(empty.get())).lookup);
  return run_rounds(timed, plan);
}

void note_times(records::CellRecord& record, const RoundTimes& rounds, const TimedCell& cell) {
  const FilterTimes &times = rounds.filters[cell.filter], &unfiltered = rounds.filters[cell.reference];
  const std::vector<double>& empty = rounds.empties[cell.empty];
  const std::vector<double> moving = add_moving(rounds.map, times);
  const auto count = static_cast<std::ptrdiff_t>(times.lookup.size());
  record.time_ms.map = summarise(rounds.map);
  record.time_ms.lookup = summarise(times.lookup);
  if (!times.screen.empty()) record.time_ms.screen = summarise(times.screen);
  record.time_ms.empty = summarise({empty.begin(), empty.begin() + count});
  record.time_ms.static_light = find_difference(times.lookup, empty);
  record.time_ms.moving = find_difference(moving, empty);
  record.time_ms.stopped = name_of(times.stopped);
  if (times.prefilter.empty())
    record.absent["time_ms.prefilter"] = "the filter reads the depth map itself";
  else
    record.time_ms.prefilter = summarise(times.prefilter);
  record.ratio_to_none.lookup = find_ratio(times.lookup, unfiltered.lookup);
  record.ratio_to_none.static_light = record.ratio_to_none.lookup;
  record.ratio_to_none.moving = find_ratio(moving, add_moving(rounds.map, unfiltered));
}

}  // namespace shadowbench::measure
