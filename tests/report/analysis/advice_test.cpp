#include "report/analysis/advice.h"

#include "report/analysis/advice_words.h"
#include "tests/report/records/synthetic.h"

namespace shadowbench::analysis {

using namespace records;
namespace {

const Demand kHardening;

Demand limit(const std::string& field, double most) { return {&limit_of(field), most}; }

/// A cell whose lookup takes `ms` and its map 1 ms, within 1 % of both; its filter has no parameters.
CellRecord measure(const std::string& scene, const std::string& filter, double ms, double rmse, int map_size = 1024) {
  CellRecord cell = make_scored_cell(scene, filter, ms, rmse);
  cell.params.clear();
  cell.map_size = map_size;
  cell.cost.map_bytes = 4LL * map_size * map_size;
  const auto within_a_percent = [](double median) {
    return OwnTime{{median, 0.99 * median, 1.01 * median, 9}, {0.99 * median, 1.01 * median}};
  };
  cell.time_ms.lookup = cell.time_ms.static_light = within_a_percent(ms);
  cell.time_ms.moving = within_a_percent(1.0 + ms);
  cell.artefact.acne = cell.artefact.leak = cell.artefact.contact_gap = cell.artefact.noise = 0.0;
  cell.key = cell_key(cell);
  return cell;
}

std::vector<std::string> labels(const std::vector<Candidate>& candidates) {
  return list_each(
      candidates, [](const Candidate& each) { return each.configuration.cells.front()->filter; });
}

std::vector<std::string> reasons(const Advice& advice) { return list_each(advice.unjudged, &Unjudged::reason); }

Advice advise_on(const std::vector<CellRecord>& cells, std::vector<Demand> demands) {
  return advise(cells, {.demands = std::move(demands)});
}

/// Ranks all of them: those that are beaten or gain nothing, too.
Advice rank(const std::vector<CellRecord>& cells, LightMotion light = LightMotion::kMoving) {
  return advise(cells, {.light = light, .whole = true});
}

void expect_refusal(const std::vector<CellRecord>& cells, const AdviceRequest& request, ErrorKind kind,
                    const std::string& word) {
  EXPECT_THAT(error_of([&] { advise(cells, request); }), is_error(kind, word));
}

TEST(Advice, WorstPlace_DecidesALimit) {
  const std::vector<CellRecord> cells = {measure("cubes", "none", 1.0, 0.01), measure("stack", "none", 1.0, 0.09),
                                         measure("cubes", "wide", 3.0, 0.03), measure("stack", "wide", 3.0, 0.02)};
  const Advice advice = advise_on(cells, {limit("error.rmse", 0.03)});
  ASSERT_THAT(labels(advice.keeping), ElementsAre("wide"));
  ASSERT_THAT(labels(advice.failing), ElementsAre("none"));
  const Verdict& verdict = advice.keeping.at(0).verdicts[0];
  EXPECT_EQ(*verdict.worst, 0.03);
  EXPECT_EQ(verdict.where, &cells[2]);
  EXPECT_EQ(advice.failing[0].verdicts[0].where, &cells[1]);
}

TEST(Advice, FiltersForTeaching_AreLeftOut_AndNamed) {
  std::vector<CellRecord> cells = {measure("cubes", "none", 3.0, 0.01), measure("cubes", "wrong", 1.0, 0.01)};
  cells[1].teaching = true;
  const Advice advice = advise_on(cells, {limit("error.rmse", 0.03)});
  EXPECT_THAT(labels(advice.keeping), ElementsAre("none"));
  EXPECT_THAT(list_advice_notes(advice, make_run().gl),
              Contains("Left out, for they show a mistake and are for teaching: wrong."));
  cells.erase(cells.begin());
  expect_refusal(cells, {}, ErrorKind::kUsage, "filters for teaching alone (wrong)");
}

TEST(Advice, EveryLimit_IsKeptUpToItsValueAndNotBeyond) {
  std::vector<CellRecord> cells = {measure("cubes", "none", 2.0, 0.25)};
  for (const metrics::Metric& metric : metrics::metric_table())
    if (!metric.limit.empty() && metric.read(cells[0]).value_or(0.0) == 0.0)
      std::get<0>(metric.member)(cells[0]) = 0.25;
  for (const Quantity& spec : limit_table()) {
    const auto value = spec.read(cells[0], LightMotion::kMoving);
    ASSERT_TRUE(value) << spec.option;
    EXPECT_THAT(advise_on(cells, {{&spec, *value}}).keeping, SizeIs(1)) << spec.option;
    EXPECT_THAT(advise_on(cells, {{&spec, *value * 0.999}}).keeping, IsEmpty()) << spec.option;
  }
}

TEST(Advice, Cost_IsTheMeanOverAllPlaces) {
  const std::vector<CellRecord> cells = {measure("cubes", "even", 4.0, 0.0), measure("stack", "even", 4.0, 0.0),
                                         measure("cubes", "uneven", 1.0, 0.0), measure("stack", "uneven", 6.0, 0.0)};
  const Advice advice = rank(cells);
  EXPECT_THAT(labels(advice.keeping), ElementsAre("uneven", "even"));
  EXPECT_DOUBLE_EQ(advice.keeping.at(0).cost.mean, 4.5);
  // Of 2 and 7 ms, each within 1 %, independently.
  const double half_width = std::hypot(0.02, 0.07) / 2.0;
  EXPECT_DOUBLE_EQ(advice.keeping.at(0).cost.quartiles.low, 4.5 - half_width);
  EXPECT_DOUBLE_EQ(advice.keeping.at(0).cost.ci95->high, 4.5 + half_width);
}

TEST(Advice, LightThatMovesOrStandsStill_HasItsOwnTime) {
  std::vector<CellRecord> cells = {measure("cubes", "wide", 4.0, 0.0), measure("cubes", "blurred", 2.0, 0.0)};
  cells[1].time_ms.moving->median = 11.0;
  const Advice moving = rank(cells), still = rank(cells, LightMotion::kStatic);
  EXPECT_THAT(labels(moving.keeping), ElementsAre("wide", "blurred"));
  EXPECT_DOUBLE_EQ(moving.keeping[1].cost.mean, 11.0);
  EXPECT_THAT(labels(still.keeping), ElementsAre("blurred", "wide"));
  EXPECT_DOUBLE_EQ(still.keeping.at(0).cost.mean, 2.0);
}

TEST(Advice, WhatLacksATimeOrACost_OrDidNotFinish_OrIsSuspect_IsNotJudged) {
  const std::tuple<void (*)(CellRecord&), CostKind, const char*> spoilt[] = {
      {[](CellRecord& cell) {
         cell.time_ms.moving.reset();
         cell.absent = {{"time_ms.prefilter", "the clock stood still"}};
       },
       CostKind::kTime, "no time_ms on cubes: the clock stood still"},
      {[](CellRecord& cell) { cell.cost.fetches.reset(); }, CostKind::kFetches,
       "no cost.fetches on cubes: not measured"},
      {[](CellRecord& cell) { cell.status = CellStatus::kTimeout; }, CostKind::kTime,
       "did not finish on cubes (timeout: its message)"},
      {[](CellRecord& cell) { cell.status = CellStatus::kSuspect; }, CostKind::kTime,
       "wrong on cubes (suspect: its message)"}};
  for (const auto& [spoil, cheapest, reason] : spoilt) {
    std::vector<CellRecord> cells = {measure("cubes", "none", 2.0, 0.1), measure("cubes", "mine", 1.0, 0.0)};
    cells[1].message = "its message";
    spoil(cells[1]);
    const Advice advice = advise(cells, {.cheapest = cheapest});
    EXPECT_THAT(labels(advice.keeping), ElementsAre("none"));
    EXPECT_THAT(reasons(advice), ElementsAre(reason));
  }
}

TEST(Advice, WhatWasNotMeasuredEverywhere_IsNotJudged) {
  const std::vector<CellRecord> cells = {measure("cubes", "none", 1.0, 0.0), measure("stack", "none", 1.0, 0.0),
                                         measure("cubes", "gone", 1.0, 0.0)};
  const Advice advice = advise(cells, {});
  EXPECT_THAT(labels(advice.keeping), ElementsAre("none"));
  EXPECT_THAT(reasons(advice), ElementsAre("not measured on stack"));
}

TEST(Advice, NeededValueThatIsNull_IsNotJudgedAndSaysWhy) {
  std::vector<CellRecord> cells = {measure("cubes", "none", 1.0, 0.0), measure("cubes", "blind", 1.0, 0.0),
                                   measure("cubes", "free", 1.0, 0.0)};
  cells[1].error = {};
  cells[1].absent["error"] = "no truth in this run";
  cells[2].cost.fetches.reset();
  cells[2].absent["cost.fetches"] = "it reads the map itself";
  const Advice advice = advise_on(cells, {limit("error.rmse", 1.0), limit("cost.fetches", 9.0)});
  EXPECT_THAT(reasons(advice), ElementsAre("no error.rmse on cubes: no truth in this run",
                                           "no cost.fetches on cubes: it reads the map itself"));
  EXPECT_THAT(count_unjudged(advice), ElementsAre("1: no error.rmse on cubes: no truth in this run",
                                                  "1: no cost.fetches on cubes: it reads the map itself"));
  EXPECT_THAT(reasons(advise_on(cells, {})), ElementsAre("no error.rmse on cubes: no truth in this run"))
      << "nobody asked for fetches, and others have an RMSE";
}

/// Whether the costs of the two cheapest are tied.
bool is_tied(const std::vector<CellRecord>& cells) {
  const std::vector<Candidate> ranked = rank(cells).keeping;
  return are_costs_tied(ranked.at(0), ranked.at(1), CostKind::kTime);
}

TEST(Advice, OfOneSurrounding_RatioIntervalsTellCostsApart) {
  std::vector<CellRecord> cells = {measure("cubes", "a", 4.0, 0.0), measure("cubes", "b", 4.2, 0.0)};
  EXPECT_FALSE(is_tied(cells));
  cells[1].time_ms.moving->ci95.low *= 0.9;
  EXPECT_TRUE(is_tied(cells));
}

TEST(Advice, OfTwoMaps_QuartilesTellCostsApart) {
  std::vector<CellRecord> cells = {measure("cubes", "a", 4.0, 0.0, 256), measure("cubes", "a", 4.2, 0.0, 1024)};
  cells[1].time_ms.moving->ci95.low *= 0.5;
  EXPECT_FALSE(is_tied(cells));
  cells[1].time_ms.moving->q1 = 4.9;
  EXPECT_TRUE(is_tied(cells));
}

TEST(Advice, CostsThatDifferOnTheWhole_AreNoTie_WhereEachPlaceIsUncertain) {
  std::vector<CellRecord> cells;
  for (const char* scene : {"a", "b", "c", "d"})
    for (const auto& [filter, ms] : {std::pair{"cheap", 4.0}, {"dear", 6.0}}) {
      OwnTime& time = *cells.emplace_back(measure(scene, filter, ms, 0.0)).time_ms.moving;
      time.ci95 = {0.8 * time.median, 1.2 * time.median};
    }
  EXPECT_FALSE(is_tied(cells));
}

TEST(Advice, EqualBytes_AreOrderedByRmse_AndWithoutByTime) {
  std::vector<CellRecord> cells = {measure("cubes", "slow", 9.0, 0.01), measure("cubes", "fast", 4.0, 0.03)};
  const AdviceRequest request{.cheapest = CostKind::kBytes};
  EXPECT_THAT(labels(advise(cells, request).keeping), ElementsAre("slow"));
  EXPECT_THAT(labels(advise(cells, request).beaten), ElementsAre("fast"));
  for (CellRecord& cell : cells) cell.error.rmse.reset();
  EXPECT_THAT(labels(advise(cells, request).keeping), ElementsAre("fast", "slow"));
}

TEST(Advice, WhatAnotherBeats_IsLeftOutAndNamed) {
  const std::vector<CellRecord> cells = {
      measure("cubes", "none", 1.0, 0.07, 1024), measure("cubes", "none", 1.5, 0.057, 2048),
      measure("cubes", "pcss", 4.0, 0.065, 1024), measure("cubes", "pcss", 6.0, 0.05, 2048)};
  const Advice advice = advise_on(cells, {});
  EXPECT_THAT(labels(advice.keeping), ElementsAre("none", "pcss"));
  EXPECT_EQ(advice.keeping[0].configuration.name, "none, map 2048");
  EXPECT_THAT(labels(advice.beaten), ElementsAre("pcss"));
  EXPECT_THAT(labels(advice.no_gain), ElementsAre("none"));
  EXPECT_EQ(advice.unfiltered, "none, map 1024");
  EXPECT_THAT(list_advice_notes(advice, make_run().gl),
              Contains("Left out, as another is no dearer and has no larger RMSE: pcss, map 1024."));
}

TEST(Advice, WhatFails_IsOrderedByHowManyLimitsItBreaks_ThenByHowMuch_ThenByCost) {
  std::vector<CellRecord> cells = {measure("cubes", "best", 9.0, 0.01), measure("cubes", "far", 3.0, 0.04),
                                   measure("cubes", "near", 6.0, 0.02), measure("cubes", "as near", 5.0, 0.02),
                                   measure("cubes", "leaky", 1.0, 0.015)};
  cells.back().artefact.leak = 0.5;
  const Advice advice = advise_on(cells, {limit("error.rmse", 0.012), limit("artefact.leak", 0.1)});
  EXPECT_THAT(labels(advice.failing), ElementsAre("as near", "near", "far", "leaky"));
  EXPECT_EQ(describe_broken(advice, advice.failing.back()), "--max-rmse 0.012 with 0.015 and --max-leak 0.1 with 0.5");
}

TEST(Advice, NothingFits_NamesTheClosest_WithALimitThatLetsItPass) {
  std::vector<CellRecord> cells = {measure("cubes", "a", 1.0, 0.0412345), measure("cubes", "b", 2.0, 0.06),
                                   measure("cubes", "c", 9.0, 0.05)};
  const Advice advice = advise_on(cells, {limit("error.rmse", 0.03), limit("time_ms", 5.0)});
  EXPECT_THAT(advice.keeping, IsEmpty());
  EXPECT_EQ(describe_failure(advice),
            "none of 3 configurations keeps the limits; a comes closest, and breaks --max-rmse 0.03 with 0.0413");
}

TEST(Advice, NothingCanBeJudged_SaysWhy) {
  std::vector<CellRecord> cells = {measure("cubes", "a", 9.0, 0.3), measure("cubes", "b", 9.0, 0.3)};
  for (CellRecord& cell : cells) cell.error.rmse.reset();
  EXPECT_EQ(describe_failure(advise_on(cells, {limit("error.rmse", 0.03)})),
            "none of 2 configurations can be judged: 2: no error.rmse on cubes: not measured");
}

TEST(Advice, RmseKeptByLessThanTheTruthsStandardError_IsMarked) {
  std::vector<CellRecord> cells = {measure("cubes", "a", 9.0, 0.0295), measure("stack", "a", 9.0, 0.001)};
  EXPECT_EQ(advise_on(cells, {limit("error.rmse", 0.03)}).keeping.at(0).verdicts[0].uncertain, &cells[0]);
  EXPECT_FALSE(advise_on(cells, {limit("error.rmse", 0.031)}).keeping.at(0).verdicts[0].uncertain);
  cells[1].truth.se = 0.04;
  EXPECT_EQ(advise_on(cells, {limit("error.rmse", 0.031)}).keeping.at(0).verdicts[0].uncertain, &cells[1])
      << "not the worst";
  EXPECT_FALSE(advise_on(cells, {limit("cost.fetches", 4.0)}).keeping.at(0).verdicts[0].uncertain);
}

TEST(Advice, ContactHardening_IsRequiredOfTheFilter) {
  std::vector<CellRecord> cells = {measure("cubes", "hard", 1.0, 0.01), measure("cubes", "soft", 4.0, 0.01)};
  cells[1].claims = {"contact-hardening"};
  for (CellRecord& cell : cells) cell.penumbra.growth = 1.0;
  const Advice advice = advise_on(cells, {kHardening});
  EXPECT_THAT(labels(advice.keeping), ElementsAre("soft"));
  EXPECT_THAT(labels(advice.failing), ElementsAre("hard"));
  cells.pop_back();
  EXPECT_THAT(describe_failure(advise_on(cells, {kHardening})),
              HasSubstr("hard comes closest, and breaks --requires contact-hardening"));
}

TEST(Advice, AClaimThatIsNotShown_IsNoAdvice) {
  std::vector<CellRecord> cells;
  for (const char* scene : {"ball", "cubes"})
    for (const char* filter : {"grows", "shrinks", "same", "unseen"}) {
      cells.push_back(measure(scene, filter, 1.0, 0.01));
      cells.back().claims = {"contact-hardening"};
      explain(cells.back(), "penumbra", {"all are narrow", true});
    }
  cells[0].penumbra.growth = 0.9;
  cells[1].penumbra.growth = -1.0;
  cells[2].penumbra.growth = 0.9;
  cells[6].penumbra.growth = 0.1;
  const Advice advice = advise_on(cells, {kHardening});
  EXPECT_THAT(labels(advice.keeping), ElementsAre("grows")) << "a place that cannot show it says nothing";
  const std::string claimed = "'contact-hardening' is claimed, not shown: ";
  const auto least = [](const char* scene, const char* by) {
    return fmt::format("on {} its penumbrae widen by {} where the truth's widen by 1, and 0.5 is the least", scene, by);
  };
  EXPECT_THAT(reasons(advice),
              ElementsAre(claimed + least("ball", "-1"), claimed + least("cubes", "0.1"), claimed + "all are narrow"));
}

/// The cells of a filter with a leak rate on "cubes", and none on "fence", where too few receivers are blocked.
std::vector<CellRecord> measure_leak_on_one(const std::string& filter, double ms, double leak) {
  std::vector<CellRecord> cells = {measure("cubes", filter, ms, 0.01), measure("fence", filter, ms, 0.01)};
  cells[0].artefact.leak = leak;
  cells[1].artefact.leak.reset();
  explain(cells[1], "artefact.leak", {"fewer than 100 receivers are blocked", true});
  return cells;
}

TEST(Advice, SceneWithNothingToSee_BarsNothingAndIsNamed) {
  std::vector<CellRecord> cells = measure_leak_on_one("leaky", 1.0, 0.5);
  for (const CellRecord& cell : measure_leak_on_one("tight", 2.0, 0.01)) cells.push_back(cell);
  const Advice advice = advise_on(cells, {limit("artefact.leak", 0.1)});
  EXPECT_THAT(advice.unjudged, IsEmpty());
  ASSERT_THAT(labels(advice.keeping), ElementsAre("tight"));
  EXPECT_THAT(labels(advice.failing), ElementsAre("leaky"));
  EXPECT_EQ(advice.keeping[0].verdicts[0].worst, 0.01);
  EXPECT_EQ(advice.keeping[0].verdicts[0].where, &cells[2]);
  EXPECT_THAT(advice.keeping[0].verdicts[0].nothing_to_see, ElementsAre(&cells[3]));
  const std::string note =
      "--max-leak 0.1 could not be judged on fence, and cannot be broken there: fewer than 100 receivers "
      "are blocked.";
  EXPECT_THAT(list_advice_notes(advice, make_run().gl), Contains(note));
  EXPECT_THAT(list_advice_notes(advise_on(cells, {limit("artefact.leak", 0.001)}), make_run().gl),
              Contains(HasSubstr("could not be judged on fence")))
      << "nothing fits";
  EXPECT_THAT(list_advice_notes(advise_on(cells, {limit("artefact.acne", 0.1)}), make_run().gl),
              Each(Not(HasSubstr("fence"))));
}

TEST(Advice, EveryFaultWithoutReceivers_BarsNothing) {
  for (const char* field : {"artefact.acne", "artefact.leak", "artefact.contact_gap"}) {
    std::vector<CellRecord> cells = measure_leak_on_one("a", 1.0, 0.0);
    cells[1].artefact = {};
    cells[1].absent.clear();
    explain(cells[1], field, {"too few", true});
    EXPECT_THAT(advise_on(cells, {limit(field, 0.1)}).keeping, SizeIs(1)) << field;
  }
}

TEST(Advice, WhatWasNotMeasuredBesideNothingToSee_IsNotJudged) {
  auto cells = measure_leak_on_one("a", 1.0, 0.0);
  cells[0].artefact = {};
  cells[0].absent["artefact"] = "the run was made with --no-truth";
  EXPECT_THAT(reasons(advise_on(cells, {limit("artefact.leak", 0.1)})),
              ElementsAre("no artefact.leak on cubes: the run was made with --no-truth"));
}

TEST(Advice, NothingToSeeAnywhere_IsNotJudgedAndSaysSo) {
  auto cells = measure_leak_on_one("a", 1.0, 0.0);
  cells[0].artefact.leak.reset();
  cells[0].absent = cells[1].absent;
  cells[0].nothing_to_see = cells[1].nothing_to_see;
  EXPECT_EQ(describe_failure(advise_on(cells, {limit("artefact.leak", 0.1)})),
            "none of 1 configurations can be judged: 1: no artefact.leak anywhere: fewer than 100 "
            "receivers are blocked");
}

TEST(Advice, Scenes_ChooseWhatIsJudged) {
  const std::vector<CellRecord> cells = {measure("cubes", "none", 1.0, 0.01), measure("stack", "none", 1.0, 0.09)};
  AdviceRequest request{.demands = {limit("error.rmse", 0.03)}};
  EXPECT_THAT(advise(cells, request).keeping, IsEmpty());
  request.scenes = {"cubes"};
  EXPECT_THAT(advise(cells, request).keeping, SizeIs(1));
  request.scenes = {"cubes", "stick"};
  expect_refusal(cells, request, ErrorKind::kUsage, "--scene: the run has no 'stick'; it has cubes, stack");
}

TEST(Advice, OfABiasInMetres_SaysThatItHoldsForOneTexelSize) {
  std::vector<CellRecord> cells = {measure("cubes", "none", 1.0, 0.01)};
  const auto says_so = Contains(HasSubstr("right for one texel size alone"));
  const auto list_notes = [&] { return list_advice_notes(advise(cells, {}), make_run().gl); };
  cells[0].bias.constant.texels = 1.0;
  EXPECT_THAT(list_notes(), Not(says_so));
  for (BiasAmount BiasRecord::*mode : {&BiasRecord::constant, &BiasRecord::slope, &BiasRecord::normal_offset}) {
    cells[0].bias = {};
    (cells[0].bias.*mode).world = 0.01;
    EXPECT_THAT(list_notes(), says_so);
  }
}

TEST(Advice, Size_ChoosesThePicture) {
  std::vector<CellRecord> cells = {measure("cubes", "none", 1.0, 0.01), measure("cubes", "none", 4.0, 0.01)};
  cells[0].width = 480;
  cells[0].height = 270;
  AdviceRequest request{.whole = true};
  EXPECT_THAT(advise(cells, request).keeping, SizeIs(2));
  EXPECT_THAT(list_advice_notes(advise(cells, request), make_run().gl),
              Contains("Pictures of 480x270, 960x540 pixels compete here, and a smaller one costs less: --size "
                       "chooses."));
  request.size = {960, 540};
  ASSERT_THAT(advise(cells, request).keeping, SizeIs(1));
  EXPECT_DOUBLE_EQ(advise(cells, request).keeping.at(0).cost.mean, 5.0);
  request.size = {2, 2};
  expect_refusal(cells, request, ErrorKind::kUsage, "--size: the run has no pictures of 2x2; it has 480x270, 960x540");
}

TEST(Advice, RunWithoutCells_IsAnInputError) { expect_refusal({}, {}, ErrorKind::kInput, "holds no cell"); }

TEST(Advice, Notes_SayWhatWeakensIt) {
  std::vector<CellRecord> cells = {measure("cubes", "none", 1.0, 0.01)};
  GlRecord gl = make_run().gl;
  EXPECT_THAT(list_advice_notes(advise_on(cells, {limit("error.rmse", 1.0)}), gl),
              ElementsAre("Times are CPU time (software rasteriser): a GPU ranks filters differently."));
  gl.software = false;
  gl.timer = TimerKind::kTimerQuery;
  EXPECT_THAT(list_advice_notes(advise_on(cells, {limit("error.rmse", 1.0)}), gl), IsEmpty());
  std::vector<CellRecord> two = {cells[0], measure("cubes", "better", 2.0, 0.001)};
  EXPECT_THAT(list_advice_notes(advise_on(two, {}), gl),
              ElementsAre("No error limit set; left out as no better than none: none."));
  cells[0].nan = 12;
  cells[0].time_ms.lookup->n = 1;
  EXPECT_THAT(list_advice_notes(advise_on(cells, {limit("error.rmse", 1.0)}), gl),
              ElementsAre(HasSubstr("a single round"), HasSubstr("12 pixels of it on cubes are not finite")));
}

TEST(Advice, LimitsInWords_LetTheValuePass) {
  for (const double value : {0.0246282, 0.03, 1e-5, 0.9999, 12.341, 123.456, 4194304.0, 0.0, 1234.5}) {
    EXPECT_GE(std::stod(format_limit(value)), value) << format_limit(value);
    EXPECT_LE(std::stod(format_limit(value)), value * 1.01) << format_limit(value);
  }
  EXPECT_EQ(format_limit(0.0246282), "0.0247");
  EXPECT_EQ(format_kept(0.0246282, 0.03), "0.0246");
  EXPECT_EQ(format_kept(0.0299962, 0.0299999), "0.029996");
}

}  // namespace
}  // namespace shadowbench::analysis
