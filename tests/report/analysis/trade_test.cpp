#include "report/analysis/trade.h"

#include "tests/report/analysis/trade_cells.h"

namespace shadowbench::analysis {
using namespace records;
namespace {

Estimate error_of(const TradeScope& scope, std::size_t i, std::size_t which) {
  return *measure(scope.configurations[i], list_error_measures()[which]).estimate;
}
Estimate cost_of(const TradeScope& scope, std::size_t i, std::size_t which) {
  return *measure(scope.configurations[i], list_cost_measures()[which]).estimate;
}

std::vector<FrontPoint> points_of(const TradeScope& scope, std::size_t cost = kMovingCost) {
  return list_points(scope, list_error_measures()[0], list_cost_measures()[cost]);
}

FrontPoint make_point(double error, double cost, std::optional<std::size_t> group = 0) {
  return {nullptr, {error, error, error}, {cost, cost, cost}, group};
}

TEST(TradeScopes, AreEachScene_AndAllTogetherFirst) {
  const std::vector<CellRecord> cells = {make_sweep_cell({"cubes"}), make_sweep_cell({"stack"})};
  const auto scopes = make_trade_scopes(cells);
  ASSERT_THAT(scopes, SizeIs(3));
  EXPECT_EQ(scopes[0].title, "all 2 scenes · 960 × 540");
  EXPECT_EQ(scopes[1].title, "cubes · view main · 960 × 540");
  EXPECT_TRUE(scopes[0].is_joint);
  EXPECT_EQ(scopes[2].title, "stack · view main · 960 × 540");
  const std::vector<CellRecord> one = {make_sweep_cell({"cubes"})};
  EXPECT_THAT(make_trade_scopes(one), SizeIs(1));
}

TEST(TradeScopes, APlaceThatTheAnswerLeavesOut_IsInNoMeanOverScenes) {
  std::vector<CellRecord> cells = {make_sweep_cell({"cubes"}), make_sweep_cell({"stack"}), make_sweep_cell({"dark"})};
  for (CellRecord& cell : cells) cell.truth.lit = 100;
  ASSERT_THAT(make_trade_scopes(cells)[0].configurations[0].cells, SizeIs(3));
  cells[2].truth.lit = 0;
  EXPECT_THAT(make_trade_scopes(cells)[0].configurations[0].cells, ElementsAre(&cells[0], &cells[1]));
}

TEST(TradeScopes, MapSizesAndFitsShareAFront_PicturesDoNot) {
  std::vector<CellRecord> cells(4, make_sweep_cell({}));
  cells[1].map_size = 2048;
  cells[2].fit = "view";
  cells[3].width = 480;
  const auto scopes = make_trade_scopes(cells);
  ASSERT_THAT(scopes, SizeIs(2));
  ASSERT_THAT(scopes[0].configurations, SizeIs(3));
  EXPECT_EQ(scopes[0].configurations[1].name, "none, map 2048, tight fit");
  EXPECT_EQ(scopes[0].configurations[2].name, "none, map 1024, view fit");
}

TEST(TradeScopes, OfAll_HoldOnlyWhatEverySceneHas) {
  const std::vector<CellRecord> cells = {make_sweep_cell({"cubes"}), make_sweep_cell({"cubes", "vsm", 4.0}),
                                         make_sweep_cell({"stack"})};
  const auto scopes = make_trade_scopes(cells);
  EXPECT_THAT(scopes[0].configurations, SizeIs(1));
}

TEST(TradeScopes, ScopesThatDifferOtherwise_HaveTheirOwnNames) {
  std::vector<CellRecord> cells = {make_sweep_cell({}), make_sweep_cell({})};
  cells[1].range.border = filters::Border::kRepeat;
  const auto scopes = make_trade_scopes(cells);
  ASSERT_THAT(scopes, SizeIs(2));
  EXPECT_NE(scopes[0].id, scopes[1].id);
  EXPECT_THAT(scopes[1].title, EndsWith(" · other settings (2)"));
}

TEST(TradeMeasures, Time_IsTheFiltersOwn_NotTheWholeLookup) {
  std::vector<CellRecord> cells = {make_sweep_cell({"cubes", "vsm", 4.0, 2.0, 0.25})};
  cells[0].time_ms.lookup->median = 77.0;
  cells[0].time_ms.moving->median = 9.0;
  const auto scopes = make_trade_scopes(cells);
  const Estimate moving = cost_of(scopes[0], 0, 0), still = cost_of(scopes[0], 0, 1);
  EXPECT_DOUBLE_EQ(still.value, 8.0);
  EXPECT_DOUBLE_EQ(still.low, 6.0);
  EXPECT_DOUBLE_EQ(still.high, 10.0);
  EXPECT_DOUBLE_EQ(moving.value, 9.0);
}

TEST(TradeMeasures, Rmse_HasItsIntervalOverPhases_ElseTheTruthsStandardError) {
  std::vector<CellRecord> cells = {make_sweep_cell({})};
  const auto rmse = [&] { return error_of(make_trade_scopes(cells)[0], 0, 0); };
  EXPECT_DOUBLE_EQ(rmse().low, 0.099);
  EXPECT_DOUBLE_EQ(rmse().high, 0.101);
  cells[0].rmse_ci95 = Interval{0.095, 0.105};
  EXPECT_DOUBLE_EQ(rmse().low, 0.095);
  EXPECT_DOUBLE_EQ(rmse().high, 0.105);
}

TEST(TradeMeasures, AllScenes_AreCombinedAsTheMeasureSays) {
  std::vector<CellRecord> cells = {make_sweep_cell({"cubes", "none", 0.0, 1.0, 0.0, 0.3}),
                                   make_sweep_cell({"stack", "none", 0.0, 1.0, 0.0, 0.4})};
  cells[0].artefact.leak = 0.1;
  cells[1].artefact.leak = 0.5;
  cells[0].error.flip = 0.1;
  cells[1].error.flip = 0.2;
  cells[0].cost.fetches = 1.0;
  cells[1].cost.fetches = 4.0;
  cells[1].time_ms.moving = OwnTime{{9.0, 9.0, 9.0, 9}, {9.0, 9.0}};
  const TradeScope all = make_trade_scopes(cells)[0];
  EXPECT_NEAR(error_of(all, 0, 0).value, std::sqrt(0.125), 1e-12);
  // Both scenes' truths are uncertain by 0.001: sqrt((0.3 * 0.001)^2 + (0.4 * 0.001)^2) / (2 rms)
  EXPECT_NEAR(error_of(all, 0, 0).high - error_of(all, 0, 0).value, 0.0005 / (2.0 * std::sqrt(0.125)), 1e-12);
  EXPECT_DOUBLE_EQ(error_of(all, 0, 2).value, 0.5);
  EXPECT_DOUBLE_EQ(error_of(all, 0, 3).value, 0.15000000000000002);
  EXPECT_NEAR(cost_of(all, 0, 0).value, 6.5, 1e-12);
  EXPECT_DOUBLE_EQ(cost_of(all, 0, 2).value, 2.5);
  EXPECT_DOUBLE_EQ(cost_of(all, 0, 3).value, 4194304.0);
}

TEST(TradeMeasures, IntervalsOfSeveralTimes_AddInQuadrature) {
  const Estimate one{4.0, 2.0, 8.0};
  const Estimate four = list_cost_measures()[0].combine({one, one, one, one});
  EXPECT_DOUBLE_EQ(four.value, 4.0);
  EXPECT_DOUBLE_EQ(four.high, 6.0);  // a fourth of sqrt(4 * 4^2)
  EXPECT_DOUBLE_EQ(four.low, 3.0);
}

// An interval that reaches 0 turned the mean of its filter alone into another one.
TEST(TradeMeasures, EveryCost_IsOneMeanOverScenes_WhateverItsIntervals) {
  for (const double low : {0.5, 0.0, -0.5}) {
    const std::vector<Estimate> scenes = {{1.0, low, 1.5}, {9.0, 8.5, 9.5}};
    for (const Quantity& cost : list_cost_measures()) {
      EXPECT_DOUBLE_EQ(cost.combine(scenes).value, 5.0) << cost.id << " " << low;
      EXPECT_STREQ(cost.over_scenes, "mean over the scenes") << cost.id;
    }
  }
}

TEST(TradeFronts, WhatHasNoValue_IsLeftOutWithItsReason) {
  std::vector<CellRecord> cells = {make_sweep_cell({}), make_sweep_cell({"cubes", "mine"}),
                                   make_sweep_cell({"cubes", "vsm"}), make_sweep_cell({"cubes", "esm"}),
                                   make_sweep_cell({"cubes", "wrong"})};
  cells[1].cost.fetches.reset();
  cells[1].absent["cost.fetches"] = "the filter reads the map's samplers itself";
  cells[2].error.rmse.reset();
  cells[2].absent["error"] = "no truth";
  cells[3].error.rmse = std::nan("");
  cells[4].status = CellStatus::kSuspect;
  const TradeScope scope = make_trade_scopes(cells)[0];
  const auto points = points_of(scope, 2);
  ASSERT_THAT(points, SizeIs(1));
  EXPECT_EQ(points[0].configuration, &scope.configurations[0]);
  const auto reason = [&](std::size_t i, const Quantity& quantity) {
    return measure(scope.configurations[i], quantity).absent;
  };
  EXPECT_EQ(reason(1, list_cost_measures()[2]), "cost.fetches: the filter reads the map's samplers itself");
  EXPECT_EQ(reason(2, list_error_measures()[0]), "error.rmse: no truth");
  EXPECT_EQ(reason(4, list_error_measures()[0]), "suspect: see the warnings");
}

TEST(TradeFronts, HoldWhatIsLessWrongThanAllThatCostsNoMore_AndNameTheCheapestThatBeatsTheRest) {
  EXPECT_THAT(find_front({make_point(0.1, 3.0), make_point(0.3, 1.0), make_point(0.2, 2.0), make_point(0.25, 2.5),
                          make_point(0.3, 4.0)}),
              ElementsAre(0, 1, 2, 2, 1));
  EXPECT_THAT(find_front({make_point(0.2, 1.0), make_point(0.1, 1.0)}), ElementsAre(1, 1)) << "as dear";
  EXPECT_THAT(find_front({make_point(0.2, 2.0), make_point(0.2, 1.0)}), ElementsAre(1, 1)) << "as wrong";
  EXPECT_THAT(find_front({}), IsEmpty());
}

TEST(TradeFronts, AreOfOneClass_AndWhatHasNoneIsComparedWithNothing) {
  EXPECT_THAT(find_front({make_point(0.3, 1.0), make_point(0.2, 0.5, 1), make_point(0.4, 2.0),
                          make_point(0.1, 0.1, std::nullopt), make_point(0.2, 0.2, std::nullopt)}),
              ElementsAre(0, 1, 0, 3, 4));
  EXPECT_FALSE(is_tied(make_point(0.1, 0.1, std::nullopt), make_point(0.1, 0.1, std::nullopt)));
  EXPECT_FALSE(is_tied(make_point(0.1, 0.1, 0), make_point(0.1, 0.1, 1)));
}

TEST(TradeFronts, WhatNeitherErrorNorCostTellsApart_IsTied) {
  FrontPoint a = make_point(0.2, 1.0), b = make_point(0.2005, 1.3);
  EXPECT_FALSE(is_tied(a, b));
  a.error = {0.2, 0.199, 0.201};
  EXPECT_FALSE(is_tied(a, b)) << "costs differ";
  a.cost = {1.0, 0.8, 1.35};
  EXPECT_TRUE(is_tied(a, b) && is_tied(b, a));
  b.error = {0.21, 0.2095, 0.2105};
  EXPECT_FALSE(is_tied(a, b) || is_tied(b, a));
}

TEST(TradeFronts, OfFewerThanThreeCells_AreNotShown) {
  std::vector<CellRecord> cells = {make_sweep_cell({}), make_sweep_cell({"cubes", "vsm"})};
  const auto has_any = [&] { return has_trade(make_trade_scopes(cells), list_cost_measures(cells)); };
  EXPECT_FALSE(has_any());
  cells.push_back(make_sweep_cell({"cubes", "esm"}));
  EXPECT_TRUE(has_any());
  cells[2].error = {};
  EXPECT_FALSE(has_any());
}

std::vector<CostChart> make_width_charts_of(const std::vector<CellRecord>& cells) {
  return make_width_charts(make_trade_scopes(cells), list_cost_measures(cells));
}

TEST(WidthCharts, HaveACurveForEachFilter_NarrowBeforeWide) {
  const auto charts = make_width_charts_of(make_crossing_cells("cubes"));
  ASSERT_THAT(charts, SizeIs(1));
  EXPECT_EQ(charts[0].title, "cubes · view main · 960 × 540 · map 1024");
  EXPECT_THAT(charts[0].widths(), ElementsAre(0.0, 2.0, 4.0, 8.0));
  ASSERT_THAT(charts[0].curves, SizeIs(3));
  const CostCurve &taps = charts[0].curves[1], &blurred = charts[0].curves[2];
  EXPECT_EQ(taps.label, "poisson");
  EXPECT_FALSE(taps.prefiltered);
  EXPECT_TRUE(blurred.prefiltered);
  ASSERT_THAT(taps.points, SizeIs(3));
  EXPECT_EQ(taps.points[2].sigma_texels, 8.0);
  EXPECT_NEAR(taps.points[2].costs[kStaticCost].value, 20.0, 1e-9);
}

TEST(WidthCharts, OfOneWidthPerFilter_AreNotDrawn) {
  EXPECT_THAT(make_width_charts_of(
                  {make_sweep_cell({}), make_taps_cell("cubes", 3.0, 2.0), make_blurred_cell("cubes", 4.0, 2.0)}),
              IsEmpty());
}

TEST(WidthCharts, MapsAreChartsOfTheirOwn_AndUnknownWidthsAreLeftOut) {
  std::vector<CellRecord> cells = make_crossing_cells("cubes");
  for (CellRecord cell : make_crossing_cells("cubes")) {
    cell.map_size = 2048;
    cell.kernel.sigma_texels.reset();
    cells.push_back(cell);
  }
  const auto charts = make_width_charts_of(cells);
  ASSERT_THAT(charts, SizeIs(1));
  EXPECT_EQ(charts[0].id, "cubes.main.960x540.map1024");
}

TEST(WidthCharts, OtherParameters_MakeOtherCurves) {
  std::vector<CellRecord> cells = make_crossing_cells("cubes");
  for (CellRecord& cell : cells) cell.params["taps"] = 16.0;
  for (const double radius : {2.0, 4.0, 8.0}) {
    CellRecord cell = make_taps_cell("cubes", radius, 9.0);
    cell.params["taps"] = 32.0;
    cells.push_back(cell);
  }
  const auto charts = make_width_charts_of(cells);
  EXPECT_THAT(charts[0].curves, SizeIs(4));
  EXPECT_EQ(charts[0].curves[1].label, "poisson (taps 16)");
  EXPECT_THAT(charts[0].curves[3].points, SizeIs(3));
}

}  // namespace

}  // namespace shadowbench::analysis
