#include "harness/measure/timing/timing.h"

#include <algorithm>
#include <cassert>
#include <numeric>
#include <random>

#include "harness/measure/timing/statistics.h"

namespace shadowbench::measure {
namespace {

constexpr int kFewestOfAnyBudget = 3;
constexpr int kRoundsPerLook =
    8;  ///< a bootstrap takes as long as a small lookup: it looks again after an eighth more rounds

/// Fisher and Yates; std::shuffle differs between standard libraries.
void shuffle(std::vector<std::size_t>& order, std::mt19937_64& generator) {
  for (std::size_t i = order.size(); i > 1; --i) std::swap(order[i - 1], order[generator() % i]);
}

class Rounds {
 public:
  Rounds(const std::vector<TimedFilter>& filters, std::size_t reference, const std::function<double()>& draw_map,
         const options::RoundLimits& limits, std::uint64_t seed, double drawn_ms,
         const std::vector<std::function<double()>>& empties, const std::function<void(double)>& on_part)
      : filters_(filters),
        empties_(empties),
        on_part_(on_part),
        reference_(reference),
        draw_map_(draw_map),
        limits_(limits),
        seed_(seed),
        generator_(seed),
        active_(filters.size()) {
    assert(!filters.empty() && reference < filters.size());
    std::iota(active_.begin(), active_.end(), std::size_t{0});
    times_.filters.resize(filters.size());
    times_.empties.resize(empties.size());
    times_.spent_ms = drawn_ms;
  }

  RoundTimes run() {
    if (!is_spent()) run_round(false);  // slower passes are warm
    for (int round = 1; round <= limits_.most; ++round) {
      run_round(true);
      if (on_part_) on_part_(find_part(round));
      if (is_enough(round)) break;
    }
    return std::move(times_);
  }

 private:
  const std::vector<TimedFilter>& filters_;
  const std::vector<std::function<double()>>& empties_;
  const std::function<void(double)>& on_part_;
  std::size_t reference_;
  const std::function<double()>& draw_map_;
  options::RoundLimits limits_;
  std::uint64_t seed_;
  std::mt19937_64 generator_;
  std::vector<std::size_t> active_;
  RoundTimes times_;
  int next_look_ = 0;  ///< rounds after which intervals are looked at again

  void run_round(bool counted) {
    const double map_ms = draw_map_();
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
      const double lookup_ms = filters_[i].lookup();
      times_.spent_ms += prefilter_ms + lookup_ms;
      if (!counted) continue;
      if (filters_[i].prefilter) times_.filters[i].prefilter.push_back(prefilter_ms);
      times_.filters[i].lookup.push_back(lookup_ms);
    }
  }

  /// The filters that still take part, and behind them the empty lookups, in an order of this round's own.
  std::vector<std::size_t> shuffle_turns() {
    std::vector<std::size_t> turns = active_;
    for (std::size_t k = 0; k < empties_.size(); ++k) turns.push_back(filters_.size() + k);
    shuffle(turns, generator_);
    return turns;
  }

  void run_empty(std::size_t which, bool counted) {
    const double ms = empties_[which]();
    times_.spent_ms += ms;
    if (counted) times_.empties[which].push_back(ms);
  }

  double find_part(int rounds) const {
    if (limits_.is_fixed()) return static_cast<double>(rounds) / limits_.most;
    return std::min(times_.spent_ms / (limits_.budget_ms * static_cast<double>(filters_.size())), 1.0);
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
      if (i == reference_ || !is_precise(times_.filters[i])) return false;
      times_.filters[i].stopped = StopReason::kPrecise;
      return true;
    });
    if (active_.size() != 1 || active_.front() != reference_) return;
    times_.filters[reference_].stopped = StopReason::kPrecise;
    active_.clear();
  }

  bool is_precise(const FilterTimes& times) const {
    const FilterTimes& reference = times_.filters[reference_];
    return is_narrow(times.lookup, reference.lookup) &&
           is_narrow(add_moving(times_.map, times), add_moving(times_.map, reference));
  }

  /// Order statistics are quick and sift out what the bootstrap, which is reported, would not call narrow.
  bool is_narrow(const std::vector<double>& numerator, const std::vector<double>& denominator) const {
    const auto width = [](const records::Ratio& r) { return (r.ci95.high - r.ci95.low) / r.median; };
    return width(order_ratio(numerator, denominator)) <= 1.5 * limits_.precision &&
           width(bootstrap_ratio(numerator, denominator, seed_)) <= limits_.precision;
  }
};

}  // namespace

std::string name_of(StopReason reason) {
  switch (reason) {
    case StopReason::kRounds: return "rounds";
    case StopReason::kPrecise: return "precise";
    case StopReason::kBudget: return "budget";
  }
  return {};
}

std::vector<double> add_moving(const std::vector<double>& map, const FilterTimes& times) {
  std::vector<double> sum = times.lookup;
  for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += map[i] + (times.prefilter.empty() ? 0.0 : times.prefilter[i]);
  return sum;
}

TimedFilter make_timed(gl::TimerKind timer, std::function<void()> prefilter, std::function<void()> lookup) {
  TimedFilter timed;
  if (prefilter) timed.prefilter = [timer, prefilter = std::move(prefilter)] { return gl::time_ms(timer, prefilter); };
  timed.lookup = [timer, lookup = std::move(lookup)] { return gl::time_ms(timer, lookup); };
  return timed;
}

RoundTimes run_rounds(const std::vector<TimedFilter>& filters, std::size_t reference,
                      const std::function<double()>& draw_map, const options::RoundLimits& limits, std::uint64_t seed,
                      double drawn_ms, const std::vector<std::function<double()>>& empties,
                      const std::function<void(double part)>& on_part) {
  return Rounds(filters, reference, draw_map, limits, seed, drawn_ms, empties, on_part).run();
}

double time_once(render::FilterPasses& filter, const render::ShadowMap& map, const render::GBuffer& gbuffer,
                 render::ImageTarget& target, gl::TimerKind timer) {
  return gl::time_ms(
      timer,
      [&] {
        filter.prefilter(map);
        filter.lookup(gbuffer, map, target);
      });
}

RoundTimes time_rounds(const std::vector<render::FilterPasses*>& filters, std::size_t reference,
                       const std::vector<std::unique_ptr<render::FilterPasses>>& empties,
                       const std::function<void()>& draw_map, const render::ShadowMap& map,
                       const render::GBuffer& gbuffer, gl::TimerKind timer, const options::RoundLimits& limits,
                       std::uint64_t seed, double drawn_ms, const std::function<void(double part)>& on_part) {
  render::ImageTarget target("timed visibility", GL_R32F, gbuffer.width(), gbuffer.height());
  std::vector<TimedFilter> timed;
  for (render::FilterPasses* filter : filters) {
    std::function<void()> prefilter;
    if (filter->has_prefilter()) prefilter = [&map, filter] { filter->prefilter(map); };
    timed.push_back(make_timed(timer, prefilter, [&, filter] { filter->lookup(gbuffer, map, target); }));
  }
  std::vector<std::function<double()>> timed_empties;
  for (const auto& empty : empties)
    timed_empties.push_back(make_timed(
                                timer, {}, [&, lookup = empty.get()] { lookup->lookup(gbuffer, map, target); })
                                .lookup);
  return run_rounds(
      timed, reference, [&] { return gl::time_ms(timer, draw_map); }, limits, seed, drawn_ms, timed_empties, on_part);
}

}  // namespace shadowbench::measure
