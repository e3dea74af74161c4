#include "harness/measure/timing.h"

#include "harness/measure/traffic_meter.h"
#include "tests/filters/filtered.h"
#include "tests/test_files.h"

namespace shadowbench::measure {
namespace {

// When enough rounds are timed, with clocks that say what the test wants.

/// Filters whose times are a mean with uniform noise of so many percent.
class FakeFilters {
 public:
  struct Fake {
    double mean_ms, noise;
    bool has_prefilter = false;
  };

  explicit FakeFilters(const std::vector<Fake>& fakes) {
    for (const Fake& fake : fakes) {
      const auto draw_one = [this, fake] { return draw(fake.mean_ms, fake.noise); };
      filters_.push_back({fake.has_prefilter ? draw_one : std::function<double()>(), draw_one});
    }
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
  FakeFilters filters({{2.0, 0.001}, {5.0, 0.001}});
  const RoundTimes times = filters.run({9, 100, 0.05, 1e6});
  EXPECT_EQ(times.map.size(), 9u);
  for (const FilterTimes& filter : times.filters) {
    EXPECT_EQ(filter.lookup.size(), 9u);
    EXPECT_EQ(filter.stopped, StopReason::kPrecise);
  }
}

TEST(Rounds, NoisyFilter_GoesOnUntilItsIntervalIsNarrow_WhileQuietOnesDropOut) {
  FakeFilters filters({{2.0, 0.001}, {5.0, 0.001}, {5.0, 0.20, true}});
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
  FakeFilters filters({{10.0, 0.5}, {10.0, 0.5}});
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
  FakeFilters filters({{10.0, 0.5}, {10.0, 0.5}});
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
  FakeFilters filters({{1.0, 0.0}, {1.0, 0.9}});
  const RoundTimes times = filters.run(options::RoundLimits::exactly(4));
  for (const FilterTimes& filter : times.filters) {
    EXPECT_EQ(filter.lookup.size(), 4u);
    EXPECT_EQ(filter.stopped, StopReason::kRounds);
  }
}

TEST(Rounds, TheMostThereMayBe_IsSaidToBeThat) {
  FakeFilters filters({{1.0, 0.5}, {1.0, 0.5}});
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

// Bytes that lookups fetch through a cache: closed forms, for receivers that step over the map texel by texel.

constexpr int kSide = 64;  // texels of the map, and pixels of most pictures
constexpr CacheShape kHoldsAll{1 << 20, 128}, kOneLine{128, 128};

/// A receiver at the centre of a texel, lit by a map of depth 0.5.
filters::Receiver make_receiver(glm::ivec2 pixel, glm::ivec2 texel, int map_side = kSide) {
  filters::Receiver r;
  r.pixel = pixel;
  r.uv = (glm::vec2(texel) + 0.5f) / static_cast<float>(map_side);
  r.depth = r.depth_unbiased = 0.25f;
  return r;
}

ModelLayer make_layer(std::vector<filters::Receiver> receivers, int map_side = kSide) {
  return {{map_side, std::vector<float>(static_cast<std::size_t>(map_side * map_side), 0.5f)}, std::move(receivers)};
}

/// A receiver for every pixel, which lie so many texels apart in the map.
ModelLayer make_steps(int width, int height, int step_texels = 1, int map_side = kSide) {
  std::vector<filters::Receiver> receivers;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      receivers.push_back(make_receiver({x, y}, step_texels * glm::ivec2(x, y), map_side));
  return make_layer(std::move(receivers), map_side);
}

double count(const std::string& filter, const std::vector<ModelLayer>& layers, const CacheShape& cache,
             glm::ivec2 pixels = glm::ivec2(kSide)) {
  return count_map_traffic(filters::request_of(filter), layers, {pixels.x, pixels.y}, {{cache}}).value().front();
}

TEST(MapTraffic, AMapThatIsReadOnce_IsFetchedOnce) {
  EXPECT_EQ(count("none", {make_steps(kSide, kSide)}, kHoldsAll), 4.0);
}

TEST(MapTraffic, OneTexelForAll_IsOneLine) {
  std::vector<filters::Receiver> receivers;
  for (int i = 0; i < kSide; ++i) receivers.push_back(make_receiver({i, i}, {5, 9}));
  EXPECT_EQ(count("none", {make_layer(receivers)}, kHoldsAll), 128.0 / kSide);
  EXPECT_EQ(count("none", {make_layer(receivers)}, kOneLine), 128.0 / kSide);
}

TEST(MapTraffic, CountsTheBytesOfTheMapsThatAreRead) {
  ModelLayer layer = make_steps(kSide, kSide);
  EXPECT_EQ(count("vsm", {layer}, kHoldsAll), 8.0) << "rg32f";
  EXPECT_EQ(count("vsm:store=rg16f", {layer}, kHoldsAll), 4.0);
  EXPECT_EQ(count("evsm4", {layer}, kHoldsAll), 16.0) << "rgba32f";
  EXPECT_EQ(count("evsm4:store=rgba16f", {layer}, kHoldsAll), 8.0);
  EXPECT_EQ(count("csm_conv", {layer}, kHoldsAll), 16.0) << "two maps of rgba16f";
  EXPECT_EQ(count("vsm_sat", {layer}, kHoldsAll), 8.0) << "a table of rg32ui";
  layer.map.texel_bytes = 2;
  EXPECT_EQ(count("none", {layer}, kHoldsAll), 2.0) << "d16";
  EXPECT_EQ(count("vsm", {layer}, kHoldsAll), 8.0) << "does not read the depth map";
}

TEST(MapTraffic, WiderKernelsReadTheSameMap_AndReadItAgainWhereTheCacheIsSmall) {
  const ModelLayer layer = make_steps(kSide, kSide);
  for (const char* filter : {"pcf2x2", "tent3x3", "box4x4", "tent7x7"}) {
    EXPECT_EQ(count(filter, {layer}, kHoldsAll), 4.0) << filter;
    EXPECT_GT(count(filter, {layer}, kOneLine), 4.0) << filter;
  }
  EXPECT_EQ(count("none", {layer}, kOneLine), 4.0) << "no two tiles share a line";
}

TEST(MapTraffic, MoreTapsNeverFetchLess) {
  constexpr int kStep = 3;
  constexpr double kMissed = 0.02;  // at most, of what lookups read that are not asked
  const ModelLayer layer = make_steps(kSide, kSide, kStep, kStep * kSide);
  for (const CacheShape& cache : {kHoldsAll, CacheShape{16 * 128, 128}, kOneLine, CacheShape{1 << 14, 64}}) {
    double fewer = 0.0;
    for (const char* filter : {"none", "pcf2x2", "tent3x3", "tent4x4", "tent5x5", "tent7x7"}) {
      const double bytes = count(filter, {layer}, cache);
      EXPECT_GE(bytes, (1.0 - kMissed) * fewer) << filter << ", a cache of " << cache.bytes;
      fewer = bytes;
    }
  }
}

TEST(MapTraffic, TilesGoRowByRow) {
  // A line is 16x16 texels here, so that two rows of tiles share each of eight lines.
  const ModelLayer layer = make_steps(2 * kSide, 16, 1, 2 * kSide);
  const auto fetched = [&](int lines) { return count("none", {layer}, {lines * 1024, 1024}, {2 * kSide, 16}); };
  EXPECT_EQ(fetched(8), 4.0);
  EXPECT_EQ(fetched(7), 8.0) << "the line that is needed next is the one that was just dropped";
  EXPECT_EQ(fetched(1), 8.0);
}

TEST(MapTraffic, TheLineThatWasNotReadForTheLongestTimeIsDropped) {
  std::vector<filters::Receiver> receivers;
  for (const int line : {0, 1, 0, 2, 0})
    receivers.push_back(make_receiver({8 * static_cast<int>(receivers.size()), 0}, {8 * line, 0}));
  EXPECT_EQ(count("none", {make_layer(receivers)}, {2 * 128, 128}, {40, 8}), 3.0 * 128.0 / 5.0);
}

TEST(MapTraffic, LayersAreDifferentMemory) {
  const ModelLayer one = make_layer({make_receiver({0, 0}, {0, 0})});
  const ModelLayer both = make_layer({make_receiver({0, 0}, {0, 0}), make_receiver({1, 0}, {1, 0})});
  EXPECT_EQ(count("none", {both}, kHoldsAll), 64.0);
  EXPECT_EQ(count("none", {one, one}, kHoldsAll), 128.0);
}

TEST(MapTraffic, NothingIsReadOutsideAMap) {
  ModelLayer layer = make_layer({make_receiver({0, 0}, {-9, 3}), make_receiver({1, 0}, {33, 33})});
  EXPECT_EQ(count("none", {layer}, kHoldsAll), 64.0);
  layer.map.border = filters::Border::kRepeat;
  EXPECT_EQ(count("none", {layer}, kHoldsAll), 128.0) << "a texel on the other side";
}

TEST(MapTraffic, AFewReceiversThatReadElsewhereAreSeen) {
  // All but one receiver of a tile read one texel.
  std::vector<filters::Receiver> receivers;
  for (int i = 0; i < 64; ++i) receivers.push_back(make_receiver({i % 8, i / 8}, {20, 20}));
  for (filters::Receiver& receiver : receivers) {
    const glm::vec2 uv = receiver.uv;
    receiver.uv = glm::vec2(0.9f);
    EXPECT_EQ(count("none", {make_layer(receivers)}, kHoldsAll, glm::ivec2(8)), 4.0);
    receiver.uv = uv;
  }
}

TEST(MapTraffic, WhereReceiversBringNothingNew_TheRestAreNotAsked_AndLittleIsMissed) {
  // The texels that the kernels cover are a square, and so are its lines.
  constexpr int kFirst = 3, kLast = kSide - 1 + 4, kShift = 32, kMap = 2 * kSide;
  ModelLayer layer = make_steps(kSide, kSide, 1, kMap);
  for (filters::Receiver& receiver : layer.receivers) receiver.uv += static_cast<float>(kShift) / kMap;
  const int columns = (kShift + kLast) / 8 - (kShift - kFirst) / 8 + 1;
  const int rows = (kShift + kLast) / 4 - (kShift - kFirst) / 4 + 1;
  const double bytes = count("tent7x7", {layer}, kHoldsAll), expected = columns * rows * 128.0 / (kSide * kSide);
  EXPECT_LE(bytes, expected);
  EXPECT_GE(bytes, 0.98 * expected);
}

TEST(MapTraffic, CachesAreCountedEachForItself) {
  const auto request = filters::request_of("tent3x3");
  const std::vector<ModelLayer> layers = {make_steps(kSide, kSide)};
  const std::vector<CacheShape> caches = {kOneLine, kHoldsAll, {1 << 20, 64}};
  const auto together = count_map_traffic(request, layers, {kSide, kSide}, caches).value();
  ASSERT_EQ(together.size(), caches.size());
  for (std::size_t i = 0; i < caches.size(); ++i) EXPECT_EQ(together[i], count("tent3x3", layers, caches[i]));
}

TEST(MapTraffic, IsNothingWithoutAModelOrAReceiver) {
  filters::FilterRequest request = filters::request_of("none");
  EXPECT_FALSE(count_map_traffic(request, {make_layer({})}, {kSide, kSide}, {{kHoldsAll}}));
  request.spec.id = "mine";
  EXPECT_FALSE(count_map_traffic(request, {make_steps(8, 8)}, {8, 8}, {{kHoldsAll}}));
}

/// Every lookup reads so often, of texels of one width, and so far.
double count_reads(const ModelLayer& layer, const PixelReads& reads, const CacheShape& cache) {
  const CountedLayer counted{layer.map, layer.receivers, std::vector<PixelReads>(kSide * kSide, reads)};
  return count_map_traffic({counted}, {kSide, kSide}, {{cache}}).value().front();
}

TEST(MapTraffic, ReadsThatWereCounted_FetchWhatAModelDoes) {
  const ModelLayer layer = make_steps(kSide, kSide);
  for (const CacheShape& cache : {kHoldsAll, CacheShape{16 * 128, 128}}) {
    EXPECT_DOUBLE_EQ(count_reads(layer, {{1, 0, 0}, 1.0}, cache), count("pcf2x2", {layer}, cache));
    EXPECT_NEAR(count_reads(layer, {{9, 0, 0}, 3.0}, cache), count("tent5x5", {layer}, cache), 0.05 * 4.0);
    EXPECT_NEAR(count_reads(layer, {{16, 0, 0}, 4.0}, cache), count("tent7x7", {layer}, cache), 0.05 * 4.0);
  }
  EXPECT_EQ(count_reads(layer, {{0, 1, 0}, 1.0}, kHoldsAll), count("vsm", {layer}, kHoldsAll));
  EXPECT_EQ(count_reads(layer, {{0, 0, 1}, 1.0}, kHoldsAll), count("evsm4", {layer}, kHoldsAll));
  EXPECT_EQ(count_reads(layer, {{1, 1, 0}, 1.0}, kHoldsAll), 4.0 + 8.0) << "of two maps";
}

}  // namespace
}  // namespace shadowbench::measure
