// Which of the candidates are called fast, balanced and best.
#include "report/analysis/picks.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

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

TEST(IdlePlaces, AreThoseWhereNoFilterIsSeenToDiffer_UnlessAllAre) {
  std::vector<records::CellRecord> cells = {make_picked({"none", 1, 0.1}, 0.0, "bright"),
                                            make_picked({"none", 1, 0.1}, 0.0, "dim")};
  cells[0].error.flip = 0.01;
  cells[1].error.flip = 0.0009;
  EXPECT_THAT(list_idle_places(point_to(cells)), ElementsAre(Place{"dim", "main"}));
  EXPECT_EQ(advise(cells, {}).places.size(), 1u);
  cells[0].error.flip = 0.0;
  EXPECT_THAT(list_idle_places(point_to(cells)), IsEmpty());
  cells[1].error.flip.reset();
  EXPECT_THAT(list_idle_places(point_to(cells)), ElementsAre(Place{"bright", "main"})) << "nobody knows of the other";
}

}  // namespace
}  // namespace shadowbench::analysis
