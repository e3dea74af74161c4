// Which of the candidates are called fast, balanced and best.
#include "report/analysis/picks.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "report/analysis/advice_words.h"
#include "report/analysis/gains.h"
#include "tests/report/records/synthetic.h"

namespace shadowbench::analysis {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

struct Made {
  const char* filter;
  double ms, rmse;
};

records::CellRecord make_picked(const Made& made, double reach = 0.0005, const char* scene = "cubes") {
  records::CellRecord cell;
  cell.scene = scene;
  cell.view = "main";
  cell.filter = made.filter;
  cell.status = records::CellStatus::kOk;
  cell.error.rmse = made.rmse;
  cell.rmse_ci95 = records::Interval{made.rmse - reach, made.rmse + reach};
  cell.time_ms.moving = records::OwnTime{{made.ms, made.ms, made.ms, 9}, {0.99 * made.ms, 1.01 * made.ms}};
  return cell;
}

std::vector<records::CellRecord> make_cells(const std::vector<Made>& all) {
  std::vector<records::CellRecord> cells;
  for (const Made& each : all) cells.push_back(make_picked(each));
  return cells;
}

std::vector<std::string> list_picks(const std::vector<records::CellRecord>& cells, const AdviceRequest& request = {}) {
  const Advice advice = advise(cells, request);
  std::vector<std::string> picks;
  for (const Pick& each : analysis::list_picks(advice))
    picks.push_back(fmt::format("{}: ", fmt::join(each.names, " and ")) +
                    advice.keeping[each.index].configuration.name);
  return picks;
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
  std::vector<std::string> left_out;
  for (const Candidate& each : advice.no_gain) left_out.push_back(each.configuration.name);
  EXPECT_THAT(left_out, ElementsAre("none", "blur"));
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
  const auto spec = std::ranges::find(limit_table(), "error.rmse", &LimitSpec::field);
  AdviceRequest request;
  request.demands = {{&*spec, 0.06, {}}};
  EXPECT_THAT(list_picks(cells, request), ElementsAre("fast: none", "balanced: pcf", "best: pcss"));
  request.demands = {{&cost_spec(CostKind::kTime), 5.0, {}}};
  EXPECT_THAT(list_picks(cells, request), ElementsAre("fast: pcf")) << "a limit on the cost asks for no gain less";
}

TEST(Picks, WithoutErrors_TheCheapestIsFast_AndNothingIsBest) {
  auto cells = make_cells({{"none", 1, 0.05}, {"pcf", 2, 0.04}});
  for (records::CellRecord& cell : cells) cell.error.rmse.reset();
  EXPECT_THAT(list_picks(cells), ElementsAre("fast: none"));
}

TEST(Gains, AreOverTheNoneOfTheSameMap) {
  auto cells =
      make_cells({{"none", 1, 0.10}, {"pcf", 2, 0.08}, {"none", 1, 0.05}, {"pcf", 2, 0.08}, {"alone", 2, 0.01}});
  cells[2].map_size = cells[3].map_size = 2048;
  cells[4].map_size = 4096;
  const auto gains = find_gains(list_configurations(point_to(cells)), point_to(cells));
  EXPECT_THAT(gains, ElementsAre(false, true, false, false, std::nullopt));
}

TEST(Gains, AClassOfWidth_IsComparedWithTheNoneOfAnother) {
  auto cells = make_cells({{"none", 1, 0.05}, {"wide", 2, 0.08}, {"wider", 3, 0.04}});
  cells[1].kernel.width_class = cells[2].kernel.width_class = "soft";
  AdviceRequest request;
  request.width_class = "soft";
  EXPECT_THAT(list_picks(cells, request), ElementsAre("fast: wider"));
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
  AdviceRequest soft;
  soft.width_class = "soft";
  EXPECT_EQ(describe_failure(advise(cells, soft)), describe_failure(advice));
}

}  // namespace
}  // namespace shadowbench::analysis
