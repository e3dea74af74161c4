// When enough rounds are timed, with clocks that say what the test wants.

#include "harness/measure/timing.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>

namespace shadowbench::measure {
namespace {

/// Filters whose times are a mean with uniform noise of so many percent.
class FakeFilters {
 public:
  void add(double mean_ms, double noise, bool prefilter = false) {
    TimedFilter filter;
    filter.lookup = [this, mean_ms, noise] { return draw(mean_ms, noise); };
    if (prefilter) filter.prefilter = [this, mean_ms, noise] { return draw(mean_ms, noise); };
    filters_.push_back(std::move(filter));
  }

  RoundTimes run(const options::RoundLimits& limits) {
    return run_rounds({filters_, [] { return 1.0; }}, {.limits = limits, .seed = 3});
  }

 private:
  std::mt19937 generator_{5};
  std::vector<TimedFilter> filters_;

  double draw(double mean_ms, double noise) {
    return mean_ms * (1.0 + noise * std::uniform_real_distribution<double>(-1.0, 1.0)(generator_));
  }
};

double width(const records::Ratio& ratio) { return (ratio.ci95.high - ratio.ci95.low) / ratio.median; }

TEST(Rounds, QuietFilters_StopAsSoonAsTheyMay) {
  FakeFilters filters;
  filters.add(2.0, 0.001);
  filters.add(5.0, 0.001);
  const RoundTimes times = filters.run({9, 100, 0.05, 1e6});
  EXPECT_EQ(times.map.size(), 9u);
  for (const FilterTimes& filter : times.filters) {
    EXPECT_EQ(filter.lookup.size(), 9u);
    EXPECT_EQ(filter.stopped, StopReason::kPrecise);
  }
}

TEST(Rounds, NoisyFilter_GoesOnUntilItsIntervalIsNarrow_WhileQuietOnesDropOut) {
  FakeFilters filters;
  filters.add(2.0, 0.001);
  filters.add(5.0, 0.001);
  filters.add(5.0, 0.20, true);
  const RoundTimes times = filters.run({9, 2000, 0.05, 1e6});
  EXPECT_EQ(times.filters[1].lookup.size(), 9u);
  const std::size_t rounds = times.filters[2].lookup.size();
  EXPECT_GT(rounds, 20u);
  EXPECT_LT(rounds, 2000u);
  EXPECT_EQ(times.filters[2].prefilter.size(), rounds);
  EXPECT_EQ(times.filters[0].lookup.size(), rounds) << "the reference stays";
  EXPECT_EQ(times.map.size(), rounds);
  EXPECT_EQ(times.filters[2].stopped, StopReason::kPrecise);
  EXPECT_LE(width(find_ratio(times.filters[2].lookup, times.filters[0].lookup)), 0.05);
  EXPECT_LE(width(find_ratio(add_moving(times.map, times.filters[2]), add_moving(times.map, times.filters[0]))), 0.05);
}

TEST(Rounds, BudgetIsSpent_AllStop_AndSaySo) {
  FakeFilters filters;
  filters.add(10.0, 0.5);
  filters.add(10.0, 0.5);
  // A round takes some 21 ms, one of them warms up.
  const RoundTimes times = filters.run({9, 1000, 0.001, 500.0});
  EXPECT_NEAR(static_cast<double>(times.map.size()), 1000.0 / 21.0 - 1.0, 6.0);
  for (const FilterTimes& filter : times.filters) EXPECT_EQ(filter.stopped, StopReason::kBudget);
}

/// Lookups right after a prefilter are slow for a while; those of filters without one are timed as they come.
TEST(Rounds, ANoisyMap_IsDrawnUntilItsIntervalIsNarrow_OrItsOwnBudgetIsSpent) {
  const auto count_maps = [](std::vector<double> times, double budget_ms) {
    std::size_t turn = 0;
    TimedPasses passes{.filters = {{{}, [] { return 1.0; }}}, .draw_map = [&] { return times[turn++ % times.size()]; }};
    return run_rounds(passes, {.limits = {.budget_ms = budget_ms}}).map.size();
  };
  EXPECT_EQ(count_maps({5.0}, 1.0), 3u);
  EXPECT_EQ(count_maps({1.0, 9.0}, 1.0), 15u);
  EXPECT_EQ(count_maps({1.0, 9.0}, 300.0), 60u);
}

TEST(Rounds, LookupsSettleAfterAPrefilter) {
  int since = 0, alone = 0;
  const TimedFilter slow{[&] { return since = 0, 10.0; }, [&] { return ++since > 3 ? 2.0 : 7.0; }},
      other{{}, [&] { return 1.0 + alone++; }};
  const RoundTimes times =
      run_rounds({{slow, other}, [] { return 1.0; }}, {.limits = options::RoundLimits::exactly(2), .seed = 3});
  EXPECT_EQ(times.filters[0].lookup, (std::vector<double>{2.0, 2.0}));
  EXPECT_EQ(times.filters[1].lookup, (std::vector<double>{2.0, 3.0}));
  EXPECT_DOUBLE_EQ(times.spent_ms, 3.0 * (1.0 + 10.0 + 3.0 * 7.0 + 2.0) + 1.0 + 2.0 + 3.0);
}

TEST(Rounds, BudgetOfNothing_StillLeavesThreeRounds) {
  FakeFilters filters;
  filters.add(10.0, 0.5);
  filters.add(10.0, 0.5);
  EXPECT_EQ(filters.run({9, 1000, 0.05, 1e-6}).map.size(), 3u);
  EXPECT_EQ(filters.run({2, 2, 0.05, 1e-6}).map.size(), 2u);
}

/// Where drawing every filter once has spent the budget, nothing more warms up, and three rounds are timed.
TEST(Rounds, SlowFilters_AreWarm_OnceTheyWereDrawn) {
  int lookups = 0;
  const std::vector<TimedFilter> filters(2, TimedFilter{{}, [&] { return 1000.0 + lookups++; }});
  const auto run = [&](const options::RoundLimits& limits, double drawn_ms) {
    lookups = 0;
    return run_rounds({filters, [] { return 1.0; }}, {.limits = limits, .seed = 3, .drawn_ms = drawn_ms});
  };
  const RoundTimes drawn = run({9, 100, 0.05, 500.0}, 2000.0);
  EXPECT_EQ(drawn.map.size(), 3u);
  EXPECT_EQ(lookups, 2 * 3);
  EXPECT_DOUBLE_EQ(drawn.spent_ms, 2000.0 + 3.0 + 6.0 * 1000.0 + 15.0);
  EXPECT_EQ(run({9, 100, 0.05, 500.0}, 10.0).map.size(), 3u);
  EXPECT_EQ(lookups, 2 * (1 + 3));
  run(options::RoundLimits::exactly(1), 1e6);
  EXPECT_EQ(lookups, 2 * (1 + 1));
}

TEST(Rounds, AFixedNumber_IsKeptWhateverTheTimesSay) {
  FakeFilters filters;
  filters.add(1.0, 0.0);
  filters.add(1.0, 0.9);
  const RoundTimes times = filters.run(options::RoundLimits::exactly(4));
  for (const FilterTimes& filter : times.filters) {
    EXPECT_EQ(filter.lookup.size(), 4u);
    EXPECT_EQ(filter.stopped, StopReason::kRounds);
  }
}

TEST(Rounds, TheMostThereMayBe_IsSaidToBeThat) {
  FakeFilters filters;
  filters.add(1.0, 0.5);
  filters.add(1.0, 0.5);
  const RoundTimes times = filters.run({2, 5, 1e-6, 1e9});
  EXPECT_EQ(times.map.size(), 5u);
  EXPECT_EQ(times.filters[1].stopped, StopReason::kRounds);
}

TEST(AddMoving, SumsMapPrefilterAndLookup_OfTheRoundsThatAFilterTookPartIn) {
  FilterTimes times;
  times.lookup = {1.0, 2.0};
  EXPECT_EQ(add_moving({10.0, 20.0, 30.0}, times), (std::vector<double>{11.0, 22.0}));
  times.prefilter = {100.0, 200.0};
  EXPECT_EQ(add_moving({10.0, 20.0, 30.0}, times), (std::vector<double>{111.0, 222.0}));
}

TEST(Summarise, GivesMedianAndQuartiles) {
  const records::Quartiles q = summarise({5.0, 1.0, 3.0, 2.0, 4.0});
  EXPECT_DOUBLE_EQ(q.median, 3.0);
  EXPECT_DOUBLE_EQ(q.q1, 2.0);
  EXPECT_DOUBLE_EQ(q.q3, 4.0);
  EXPECT_EQ(q.n, 5);
  EXPECT_DOUBLE_EQ(summarise({1.0, 2.0}).median, 1.5);
}

TEST(MedianRatio, IsOneForEqualTimes_WithoutSpread) {
  const records::Ratio r = find_ratio({2.0, 3.0, 4.0}, {2.0, 3.0, 4.0});
  EXPECT_DOUBLE_EQ(r.median, 1.0);
  EXPECT_DOUBLE_EQ(r.ci95.low, 1.0);
  EXPECT_DOUBLE_EQ(r.ci95.high, 1.0);
}

TEST(MedianRatio, PairsRounds_SoThatCommonDriftCancels) {
  const records::Ratio r = find_ratio({2.0, 20.0, 200.0}, {1.0, 10.0, 100.0});
  EXPECT_DOUBLE_EQ(r.ci95.low, 2.0);
  EXPECT_DOUBLE_EQ(r.ci95.high, 2.0);
}

TEST(MedianRatio, OfOne_IsItself_AndOfMoreDenominatorsTheFirstAreUsed) {
  EXPECT_DOUBLE_EQ(find_ratio({2.0, 4.0}, {1.0, 2.0, 1e9}).median, 2.0);
  const records::Ratio r = find_ratio({3.0}, {2.0});
  EXPECT_EQ(r.ci95.low, 1.5);
  EXPECT_EQ(r.ci95.high, 1.5);
}

/// Times have a long tail: an exponential's, or one whose variance is infinite.
TEST(MedianInterval, HoldsTheTrueMedian_NinetyFiveTimesInAHundred) {
  std::mt19937_64 generator(5);
  std::normal_distribution<double> normal;
  std::exponential_distribution<double> exponential;
  std::student_t_distribution<double> heavy(2.0);
  const std::pair<std::function<double()>, double> kinds[] = {{[&] { return normal(generator); }, 0.0},
                                                              {[&] { return exponential(generator); }, std::log(2.0)},
                                                              {[&] { return heavy(generator); }, 0.0}};
  for (const auto& [draw, median] : kinds) {
    for (const std::size_t count : {3u, 4u, 5u, 6u, 7u, 8u, 10u, 15u, 40u, 100u}) {
      constexpr int kTrials = 4000;
      int covered = 0;
      for (int trial = 0; trial < kTrials; ++trial) {
        std::vector<double> values(count);
        std::ranges::generate(values, draw);
        const records::Interval interval = find_difference(values, std::vector<double>(count, 0.0)).ci95;
        covered += interval.low <= median && median <= interval.high ? 1 : 0;
      }
      EXPECT_GE(covered, 0.925 * kTrials) << count;
      EXPECT_LE(covered, 0.99 * kTrials) << count;
    }
  }
}

}  // namespace
}  // namespace shadowbench::measure
