#include "report/analysis/machines/machine_kinds.h"

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "base/error.h"
#include "report/analysis/advice_words.h"
#include "report/analysis/cost_curves.h"
#include "report/analysis/trade.h"
#include "report/records/absence.h"
#include "report/records/json_io.h"
#include "tests/report/analysis/mixed_cells.h"

namespace shadowbench::analysis {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using ::testing::SizeIs;

std::string label_of(const std::vector<Candidate>& candidates, std::size_t i) {
  return candidates.at(i).configuration.cells.front()->filter;
}

TEST(MachineKinds, AreCountedInTheOrderOfTheCells) {
  std::vector<records::CellRecord> cells = make_mixed_cells();
  const auto machines = count_machines(cells);
  ASSERT_THAT(machines, SizeIs(2));
  EXPECT_EQ(machines[0].kind->cpu, "A slow CPU");
  EXPECT_EQ(machines[0].cells, 2u);
  EXPECT_EQ(machines[1].cells, 1u);
  EXPECT_TRUE(mixes_machines(cells));
  EXPECT_EQ(warn_of_mixed_machines(machines).find(kMixedMachines), 0u);
  EXPECT_THAT(warn_of_mixed_machines(machines),
              HasSubstr("machine 2 is A fast CPU, 64 cores, A GPU, GPU time (timer query) (1 cell). "));
  cells[2].machine.reset();
  EXPECT_TRUE(mixes_machines(cells)) << "one that is not known is another one";
}

TEST(MachineKinds, OfOneKind_CellsCompareAsTheyAre) {
  std::vector<records::CellRecord> cells = make_mixed_cells();
  for (records::CellRecord& cell : cells) cell.machine.reset();
  EXPECT_FALSE(withhold_mixed_times(cells)) << "cells of before";
  for (records::CellRecord& cell : cells) cell.machine = make_kind("A CPU");
  EXPECT_FALSE(withhold_mixed_times(cells));
  EXPECT_FALSE(withhold_mixed_times({}));
  EXPECT_EQ(frame_cost_kind(cells), CostKind::kTime);
  EXPECT_EQ(list_cost_measures(cells)[kMovingCost].id, "moving");
}

TEST(MixedMachines, HaveNoTimes_AndSayWhy) {
  std::vector<records::CellRecord> cells = make_mixed_cells();
  cells[0].lights = std::vector<records::LightCountRecord>{{}};
  cells[0].absent["time_ms.prefilter"] = "none is needed";
  const auto withheld = withhold_mixed_times(cells);
  ASSERT_TRUE(withheld);
  const records::CellRecord& cell = withheld->front();
  EXPECT_FALSE(frame_time(cell, LightMotion::kMoving) || frame_time(cell, LightMotion::kStatic) || cell.lights);
  EXPECT_EQ(cell.ratio_to_none.moving->median, cells[0].ratio_to_none.moving->median);
  for (const char* field : {"time_ms.prefilter", "time_ms.moving", "lights"})
    EXPECT_THAT(records::to_json(cell)["absent"].dump() + records::explain_absence(cell, field),
                HasSubstr("times do not compare"))
        << field;
}

/// By milliseconds `fast` would beat `slow`; beside its own `none` it costs more.
TEST(MixedMachines, FrontsFollowRatios) {
  const auto withheld = withhold_mixed_times(make_mixed_cells());
  ASSERT_TRUE(withheld);
  const TradeScope scope = make_trade_scopes(*withheld)[0];
  EXPECT_EQ(scope.costs[kMovingCost].id, "moving_ratio");
  EXPECT_EQ(scope.costs[kStaticCost].id, "static_ratio");
  for (const std::size_t cost : {kMovingCost, kStaticCost}) {
    const TradeFront front = make_trade_front(scope, 0, cost);
    EXPECT_EQ(front.points[1].cost.value, 2.0);
    EXPECT_EQ(front.points[1].cost.high, 2.0 * 1.01);
    EXPECT_EQ(front.placements[2].standing, Standing::kDominated);
    EXPECT_EQ(front.placements[2].by, 1u);
  }
}

TEST(MixedMachines, ByTheirTimes_WouldStandTheOtherWay) {
  std::vector<records::CellRecord> cells = make_mixed_cells();
  for (records::CellRecord& cell : cells) cell.machine.reset();
  const TradeFront front = make_trade_front(make_trade_scopes(cells)[0], 0, kMovingCost);
  EXPECT_EQ(front.placements[1].standing, Standing::kDominated);
  EXPECT_EQ(front.placements[1].by, 2u);
}

TEST(MixedMachines, EachMapHasAFrontOfItsOwn) {
  std::vector<records::CellRecord> cells = make_mixed_cells();
  for (const records::CellRecord& each : make_mixed_cells()) {
    cells.push_back(each);
    cells.back().map_size = 4096;
    cells.back().error.rmse = *each.error.rmse / 2.0;
    cells.back().key = records::cell_key(cells.back());
  }
  const TradeScope scope = make_trade_scopes(*withhold_mixed_times(cells))[0];
  const TradeFront front = make_trade_front(scope, 0, kMovingCost);
  EXPECT_THAT(front.members, ElementsAre(0, 1, 3, 4)) << "the large map beats nothing of the small one";
  EXPECT_EQ(front.placements[5].by, 4u);
  const std::size_t fetches = 2;
  EXPECT_THAT(make_trade_front(scope, 0, fetches).members, ElementsAre(4)) << "other costs compare over all maps";
}

TEST(MixedMachines, AdviceFollowsRatios) {
  const auto cells = *withhold_mixed_times(make_mixed_cells());
  AdviceRequest request;
  request.demands = {{&cost_spec(CostKind::kBytes), 1e9, {}}};
  request.whole = true;
  const Advice advice = advise(cells, request);
  ASSERT_THAT(advice.keeping, SizeIs(3));
  EXPECT_EQ(label_of(advice.keeping, 1), "slow");
  EXPECT_EQ(label_of(advice.keeping, 2), "fast");
  EXPECT_EQ(advice.keeping[1].cost.mean, 2.0);
  const records::GlRecord gl = records::make_run().gl;
  EXPECT_EQ(format_cost(advice.keeping[1].cost.mean, advice.request.cheapest, gl), "2 × none");
  EXPECT_EQ(describe_choice(advice), "lowest ratio to 'none'");
  EXPECT_EQ(describe_runner_up(advice, gl),
            "dearer by 1 × none (100 %); the 95 % intervals are apart; its RMSE is lower by 0.05 [0.049, 0.051]");
  EXPECT_THAT(list_run_notes(advice, gl), ElementsAre(HasSubstr("their times do not compare")));
}

TEST(MixedMachines, LimitOnTimes_IsRefused) {
  const auto cells = *withhold_mixed_times(make_mixed_cells());
  AdviceRequest request;
  request.demands = {{&cost_spec(CostKind::kTime), 1e9, {}}};
  try {
    advise(cells, request);
    FAIL() << "nothing was thrown";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::kUsage);
    EXPECT_THAT(error.what(), HasSubstr("--max-ms: several kinds of machine measured the run"));
  }
}

/// A ratio on a large map may be the smaller one, and its frame the slower one: nothing is said of the two.
TEST(MixedMachines, AdviceComparesNoRatiosOfTwoMaps) {
  std::vector<records::CellRecord> cells = make_mixed_cells();
  cells.erase(cells.begin());
  cells[0].map_size = 4096;  // the ratio is 2; that of the other map is 3
  cells[0].error.rmse = 0.04;
  cells[0].key = records::cell_key(cells[0]);
  const Advice advice = advise(*withhold_mixed_times(cells), {});
  ASSERT_THAT(advice.keeping, SizeIs(2));
  EXPECT_EQ(label_of(advice.keeping, 0), "fast") << "the smaller map";
  const CostGap gap = compare_costs(advice.keeping[0], advice.keeping[1], CostKind::kRatio);
  EXPECT_TRUE(gap.tied);
  EXPECT_EQ(gap.basis, Basis::kNone);
  EXPECT_THAT(describe_runner_up(advice, records::make_run().gl),
              HasSubstr("is to another 'none': fast, map 1024 is named first for its smaller picture or"));
  EXPECT_EQ(describe_choice(advice), "lowest ratio to 'none', on the smallest picture and map,");
}

TEST(MixedMachines, WhatNeedsMilliseconds_IsSilent) {
  std::vector<records::CellRecord> cells = make_mixed_cells();
  for (const records::CellRecord& each : make_mixed_cells()) {
    cells.push_back(each);
    cells.back().map_size = 512;
    cells.back().fit = "view";
    cells.back().key = records::cell_key(cells.back());
  }
  for (records::CellRecord& cell : cells) {
    cell.lights = {{1, {1.0, 1.0, 1.0, 9}, {2.0, 2.0, 2.0, 9}, {1.0, {1.0, 1.0}}, {1.0, {1.0, 1.0}}, 1024},
                   {2, {2.0, 2.0, 2.0, 9}, {4.0, 4.0, 4.0, 9}, {1.0, {1.0, 1.0}}, {1.0, {1.0, 1.0}}, 2048}};
    cell.cost.bytes_per_texel = 4;
  }
  const auto withheld = *withhold_mixed_times(cells);
  ASSERT_THAT(make_light_charts(cells, make_trade_scopes(cells)), Not(IsEmpty()));
  EXPECT_THAT(make_light_charts(withheld, make_trade_scopes(withheld)), IsEmpty());
  ASSERT_THAT(list_map_families(cells), Not(IsEmpty()));
  EXPECT_THAT(list_map_families(withheld), IsEmpty());
}

}  // namespace
}  // namespace shadowbench::analysis
