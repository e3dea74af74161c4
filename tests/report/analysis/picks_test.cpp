// Which of the candidates are called fast, balanced and best.
#include <fmt/ranges.h>

#include "report/analysis/advice.h"
#include "report/analysis/advice_words.h"
#include "report/analysis/cells.h"
#include "tests/report/analysis/made_up_runs.h"
#include "tests/report/records/synthetic.h"

namespace shadowbench::analysis {
namespace {

std::vector<records::CellRecord> make_cells(const std::vector<Made>& all) {
  return records::list_each(
      all, [](const Made& made) { return make_picked(made); });
}

std::vector<std::string> list_names(const std::vector<Candidate>& candidates) {
  return records::list_each(
      candidates, [](const Candidate& each) { return each.configuration.name; });
}

std::vector<std::string> list_picks(const std::vector<records::CellRecord>& cells, const AdviceRequest& request = {}) {
  const Advice advice = advise(cells, request);
  return records::list_each(analysis::list_picks(advice), [&](const Pick& each) {
    return fmt::format("{}: {}", fmt::join(each.names, " and "), advice.keeping[each.index].configuration.name);
  });
}

TEST(Picks, FastIsTheCheapestWithAGain_BestHasTheLeastError_AndTheKneeIsBetween) {
  const auto cells = make_cells({{"none", 1, 0.10},
                                 {"blur", 1.5, 0.10},
                                 {"pcf", 2, 0.08},
                                 {"knee", 4, 0.05},
                                 {"waste", 9, 0.06},
                                 {"dear", 30, 0.045}});
  EXPECT_THAT(list_picks(cells), ElementsAre("fast: pcf", "balanced: knee", "best: dear"));
  const Advice advice = advise(cells, {});
  EXPECT_THAT(list_names(advice.no_gain), ElementsAre("none"));
  EXPECT_THAT(list_names(advice.beaten), ElementsAre("blur", "waste"));
}

TEST(Picks, ALargerMapWithoutAFilter_MayWin) {
  auto cells = make_cells({{"none", 1, 0.08}, {"pcss", 27, 0.065}, {"none", 2, 0.057}});
  cells[2].map_size = 2048;
  const Advice advice = advise(cells, {});
  const std::vector<Pick> picks = analysis::list_picks(advice);
  ASSERT_THAT(picks, SizeIs(1));
  EXPECT_EQ(advice.keeping[0].configuration.name, "none, map 2048");
  EXPECT_EQ(picks[0].why, "the cheapest clearly better than none, map 0");
}

TEST(Picks, OfErrorsAndCostsThatCannotBeToldApart_TheSmallerSeamIsBest_AndASeamThatIsSeenIsSaid) {
  auto cells = make_cells({{"none", 1, 0.10}, {"pcf", 5, 0.0447}, {"blended", 5, 0.0449}});
  for (auto& cell : cells) cell.artefact.seam = cell.filter == std::string("blended") ? 0.0132 : 0.0485;
  EXPECT_THAT(list_picks(cells), ElementsAre("fast: pcf", "best: blended"));
  EXPECT_EQ(analysis::list_picks(advise(cells, {})).at(0).why,
            "the cheapest clearly better than none; its cascades show a seam of 0.0485");
  cells[2] = make_picked({"blended", 5, 0.06});
  cells[2].artefact.seam = 0.0132;
  EXPECT_THAT(list_picks(cells), ElementsAre("fast and best: pcf")) << "the errors differ";
  const Advice advice = advise(cells, {});
  EXPECT_THAT(list_names(advice.keeping), ElementsAre("pcf", "blended")) << "its seam is smaller: nothing beats it";
}

TEST(Picks, WhatIsMuchMoreWrong_IsNoBestOne_ThoughTooFewPhasesTellIt) {
  std::vector<records::CellRecord> cells = make_cells({{"none", 1, 0.09}, {"lispsm", 2, 0.0714}, {"psm", 3, 0.0443}});
  EXPECT_THAT(list_picks(cells), Contains("best: psm"));
  for (records::CellRecord& cell : cells) cell.rmse_ci95 = records::Interval{0.0, 2.0};
  EXPECT_THAT(list_picks(cells), ElementsAre("fast: none"));
}

TEST(Picks, NoneAlone_IsWhatThereIs) {
  EXPECT_THAT(list_picks(make_cells({{"none", 1, 0.08}})), ElementsAre("fast: none"));
}

TEST(Picks, WhatIsAboveTheStraightLine_IsNoKnee) {
  EXPECT_THAT(list_picks(make_cells({{"none", 1, 0.10}, {"pcf", 2, 0.08}, {"slow", 8, 0.075}, {"best", 10, 0.04}})),
              ElementsAre("fast: pcf", "best: best"));
}

TEST(Picks, OfErrorsThatCannotBeToldApart_TheCheapestIsBest) {
  auto cells = make_cells({{"none", 1, 0.10}, {"pcf", 2, 0.08}, {"wide", 5, 0.0402}, {"wider", 9, 0.04}});
  EXPECT_THAT(list_picks(cells), ElementsAre("fast: pcf", "best: wide"));
  cells[2] = make_picked({"wide", 5, 0.0402}, 0.0001);
  cells[3] = make_picked({"wider", 9, 0.04}, 0.0001);
  EXPECT_THAT(list_picks(cells), ElementsAre("fast: pcf", "balanced: wide", "best: wider"));
}

TEST(Picks, OneThatIsCheapestAndLeastWrong_IsBoth) {
  EXPECT_THAT(list_picks(make_cells({{"none", 1, 0.1}, {"pcf", 2, 0.05}, {"pcss", 9, 0.06}})),
              ElementsAre("fast and best: pcf"));
}

TEST(Picks, ALimitOnAnError_LetsNoneThrough) {
  const auto cells = make_cells({{"none", 1, 0.05}, {"pcf", 2, 0.04}, {"pcss", 9, 0.03}});
  EXPECT_THAT(list_picks(cells, {.demands = {{&limit_of("error.rmse"), 0.06}}}),
              ElementsAre("fast: none", "balanced: pcf", "best: pcss"));
  EXPECT_THAT(list_picks(cells, {.demands = {{&cost_spec(CostKind::kTime), 5.0}}}), ElementsAre("fast and best: pcf"))
      << "a limit on the cost asks for no gain less";
}

TEST(Picks, WithoutErrors_TheCheapestIsFast_AndNothingIsBest) {
  auto cells = make_cells({{"none", 1, 0.05}, {"pcf", 2, 0.04}});
  for (records::CellRecord& cell : cells) cell.error.rmse.reset();
  EXPECT_THAT(list_picks(cells), ElementsAre("fast: none"));
}

TEST(Picks, AClassOfWidth_IsComparedWithTheNoneOfAnother) {
  auto cells = make_cells({{"none", 1, 0.05}, {"wide", 2, 0.08}, {"wider", 3, 0.04}});
  cells[1].kernel.width_class = cells[2].kernel.width_class = "soft";
  EXPECT_THAT(list_picks(cells, {.width_class = "soft"}), ElementsAre("fast and best: wider"));
}

/// A cell of 100 x 100 pixels, of which so many are receivers at a penumbra, with this FLIP of the picture.
records::CellRecord make_judged(const char* scene, std::int64_t penumbra, std::optional<double> flip,
                                std::int64_t lit = 5000) {
  records::CellRecord cell = make_picked({"none", 1, 0.1}, 0.0, scene);
  cell.width = cell.height = 100;
  cell.receivers = 6000;
  cell.truth.lit = lit;
  cell.truth.penumbra = penumbra;
  cell.error.flip = flip;
  return cell;
}

PlaceState judge(const std::vector<records::CellRecord>& cells) {
  return judge_place(point_to(cells), place_of(cells.front()));
}

TEST(PlaceStates, ASmallShadowMatters_ThoughTheMeanOverThePictureIsLow) {
  EXPECT_EQ(judge({make_judged("spot", 100, 0.0002)}), PlaceState::kMatters) << "0.02 at each receiver of its penumbra";
  EXPECT_EQ(judge({make_judged("dim", 5000, 0.0009)}), PlaceState::kIdle);
  EXPECT_EQ(judge({make_judged("dim", 5000, 0.0009), make_judged("dim", 5000, 0.009)}), PlaceState::kMatters)
      << "one filter is seen to differ";
}

TEST(PlaceStates, WhatNothingInViewReceives_WasNotTested) {
  EXPECT_EQ(judge({make_judged("lamp", 0, 0.0, 0)}), PlaceState::kUnlit);
  EXPECT_EQ(judge({make_judged("lamp", 0, 0.02, 0)}), PlaceState::kUnlit) << "a filter that leaks shows no edge";
  EXPECT_EQ(judge({make_judged("open", 0, 0.0)}), PlaceState::kEdgeless);
  records::CellRecord away = make_picked({"none", 1, 0.1});
  away.receivers = 0;
  EXPECT_EQ(judge({away}), PlaceState::kUnlit) << "a run without truth knows it too";
}

TEST(PlaceStates, OfWhatHasNoTruth_NobodyKnows) {
  const records::CellRecord unknown = make_picked({"none", 1, 0.1}, 0.0, "dim");
  EXPECT_EQ(judge({unknown}), PlaceState::kMatters);
  EXPECT_EQ(judge({make_judged("dim", 5000, 0.0009), unknown}), PlaceState::kMatters);
  EXPECT_EQ(judge({make_judged("dim", 0, 0.0, 0), unknown}), PlaceState::kUnlit) << "that of a filter that failed";
}

TEST(LeftOutPlaces, IdleOnesCount_WhereNoOtherMatters_AndUntestedOnesNever) {
  const LeftOutPlace dim{{"dim", "main"}, PlaceState::kIdle}, lamp{{"lamp", "main"}, PlaceState::kUnlit};
  std::vector<records::CellRecord> cells = {make_judged("sun", 1000, 0.01), make_judged("dim", 5000, 0.0009),
                                            make_judged("lamp", 0, 0.0, 0)};
  EXPECT_THAT(list_left_out(point_to(cells)), ElementsAre(dim, lamp));
  EXPECT_EQ(advise(cells, {}).places.size(), 1u);
  EXPECT_EQ(describe_judged_lights(advise(cells, {})),
            "2 of 3 lights judged; lamp not tested: no receiver in view sees it");
  cells[0].error.flip = 0.0;
  EXPECT_THAT(list_left_out(point_to(cells)), ElementsAre(lamp));
  cells.erase(cells.end() - 1);
  EXPECT_EQ(describe_judged_lights(advise(cells, {})), "");
}

TEST(LeftOutPlaces, WithAllLightsUnseen_NothingIsPicked_AndItIsSaidWhy) {
  const std::vector<records::CellRecord> cells = {make_judged("lamp", 0, 0.0, 0), make_judged("open", 0, 0.0)};
  const Advice advice = advise(cells, {});
  EXPECT_THAT(advice.keeping, IsEmpty());
  EXPECT_EQ(describe_failure(advice),
            "0 of 2 lights judged; lamp not tested: no receiver in view sees it; open not tested: no edge of its "
            "shadows is in view");
  EXPECT_EQ(describe_failure(advise(cells, {.width_class = "soft"})), describe_failure(advice));
}

}  // namespace
}  // namespace shadowbench::analysis
