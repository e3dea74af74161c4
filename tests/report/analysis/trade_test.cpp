#include "report/analysis/trade.h"

#include <gmock/gmock.h>

#include "report/analysis/front_words.h"
#include "report/pages/fronts_csv.h"
#include "trade_cells.h"

namespace shadowbench::analysis {

using namespace records;
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::SizeIs;

const Estimate& error_of(const TradeScope& scope, std::size_t i, std::size_t measure) {
  return *scope.configurations[i].errors[measure].estimate;
}
const Estimate& cost_of(const TradeScope& scope, std::size_t i, std::size_t measure) {
  return *scope.configurations[i].costs[measure].estimate;
}

TEST(TradeScopes, AreEachScene_AndAllTogetherFirst) {
  const auto scopes = make_trade_scopes({make_sweep_cell({"cubes"}), make_sweep_cell({"stack"})});
  ASSERT_THAT(scopes, SizeIs(3));
  EXPECT_EQ(scopes[0].title, "all 2 scenes · 960 × 540");
  EXPECT_EQ(scopes[1].title, "cubes · view main · 960 × 540");
  EXPECT_EQ(scopes[2].scene, "stack");
  EXPECT_THAT(make_trade_scopes({make_sweep_cell({"cubes"})}), SizeIs(1));
}

TEST(TradeScopes, MapSizesShareAFront_PicturesDoNot) {
  std::vector<records::CellRecord> cells = {make_sweep_cell({}), make_sweep_cell({}), make_sweep_cell({})};
  cells[1].map_size = 2048;
  cells[2].width = 480;
  const auto scopes = make_trade_scopes(cells);
  ASSERT_THAT(scopes, SizeIs(2));
  ASSERT_THAT(scopes[0].configurations, SizeIs(2));
  EXPECT_EQ(scopes[0].configurations[1].label, "none · map 2048");
}

TEST(TradeScopes, OfAll_HoldOnlyWhatEverySceneHas) {
  const auto scopes = make_trade_scopes(
      {make_sweep_cell({"cubes"}), make_sweep_cell({"cubes", "vsm", 4.0}), make_sweep_cell({"stack"})});
  EXPECT_THAT(scopes[0].configurations, SizeIs(1));
  EXPECT_EQ(scopes[0].incomplete, 1u);
}

TEST(TradeScopes, Labels_NameOnlyWhatDiffers) {
  std::vector<records::CellRecord> cells = {make_sweep_cell({"cubes", "vsm", 2.0}),
                                            make_sweep_cell({"cubes", "vsm", 4.0}), make_sweep_cell({})};
  for (records::CellRecord& cell : cells) cell.params["store"] = std::string("rg32f");
  const auto scopes = make_trade_scopes(cells);
  EXPECT_EQ(scopes[0].configurations[0].label, "vsm (radius 2)");
  EXPECT_EQ(scopes[0].configurations[2].label, "none");
}

TEST(TradeScopes, ScopesThatDifferOtherwise_HaveTheirOwnNames) {
  std::vector<records::CellRecord> cells = {make_sweep_cell({}), make_sweep_cell({})};
  cells[1].fit = "sphere";
  const auto scopes = make_trade_scopes(cells);
  ASSERT_THAT(scopes, SizeIs(2));
  EXPECT_NE(scopes[0].id, scopes[1].id);
}

TEST(TradeMeasures, Time_IsTheRatioTimesTheReferencesMedian) {
  std::vector<records::CellRecord> cells = {make_sweep_cell({}), make_sweep_cell({"cubes", "vsm", 4.0, 2.0, 0.25})};
  cells[1].time_ms.lookup->median = 77.0;  // drifted: the ratio counts
  const auto scopes = make_trade_scopes(cells);
  const Estimate still = cost_of(scopes[0], 1, 0), moving = cost_of(scopes[0], 1, 1);
  EXPECT_DOUBLE_EQ(still.value, 8.0);
  EXPECT_DOUBLE_EQ(still.low, 6.0);
  EXPECT_DOUBLE_EQ(still.high, 10.0);
  EXPECT_DOUBLE_EQ(moving.value, 16.0);
}

TEST(TradeMeasures, WithoutAReference_TimesAreMedianAndQuartiles) {
  records::CellRecord cell = make_cell("cubes", "vsm", 8.0);
  const auto scopes = make_trade_scopes({cell});
  EXPECT_DOUBLE_EQ(cost_of(scopes[0], 0, 0).value, 8.0);
  EXPECT_DOUBLE_EQ(cost_of(scopes[0], 0, 0).low, 8.0 * 0.98);
  EXPECT_DOUBLE_EQ(cost_of(scopes[0], 0, 1).value, 11.5);
}

TEST(TradeMeasures, Rmse_HasTheTruthsStandardError) {
  const auto scopes = make_trade_scopes({make_sweep_cell({})});
  EXPECT_DOUBLE_EQ(error_of(scopes[0], 0, 0).low, 0.099);
  EXPECT_DOUBLE_EQ(error_of(scopes[0], 0, 0).high, 0.101);
}

TEST(TradeMeasures, AllScenes_AreCombinedAsTheMeasureSays) {
  std::vector<records::CellRecord> cells = {make_sweep_cell({"cubes", "none", 0.0, 1.0, 0.0, 0.3}),
                                            make_sweep_cell({"stack", "none", 0.0, 1.0, 0.0, 0.4})};
  cells[0].artefact.leak = 0.1;
  cells[1].artefact.leak = 0.5;
  cells[0].error.flip = 0.1;
  cells[1].error.flip = 0.2;
  cells[0].cost.fetches = 1.0;
  cells[1].cost.fetches = 4.0;
  cells[1].time_ms.lookup->median = 9.0;
  const TradeScope all = make_trade_scopes(cells)[0];
  EXPECT_NEAR(error_of(all, 0, 0).value, std::sqrt(0.125), 1e-12);
  // Both scenes' truths are uncertain by 0.001: sqrt((0.3 * 0.001)^2 + (0.4 * 0.001)^2) / (2 rms)
  EXPECT_NEAR(error_of(all, 0, 0).high - error_of(all, 0, 0).value, 0.0005 / (2.0 * std::sqrt(0.125)), 1e-12);
  EXPECT_DOUBLE_EQ(error_of(all, 0, 2).value, 0.5);
  EXPECT_DOUBLE_EQ(error_of(all, 0, 3).value, 0.15000000000000002);
  EXPECT_NEAR(cost_of(all, 0, 0).value, 6.0, 1e-12);
  EXPECT_DOUBLE_EQ(cost_of(all, 0, 2).value, 2.5);
  EXPECT_DOUBLE_EQ(cost_of(all, 0, 3).value, 4194304.0);
}

TEST(TradeMeasures, IntervalsOfSeveralTimes_AddInQuadrature) {
  const Estimate one{4.0, 2.0, 8.0};
  const Estimate two = list_cost_measures()[0].combine({one, one, one, one});
  EXPECT_NEAR(two.value, 4.0, 1e-12);
  EXPECT_NEAR(two.high, 4.0 * std::sqrt(2.0), 1e-12);  // a fourth of sqrt(4 log(2)^2)
  EXPECT_NEAR(two.low, 4.0 / std::sqrt(2.0), 1e-12);
}

TEST(TradeFronts, AbsentValues_AreLeftOutWithTheirReason) {
  std::vector<records::CellRecord> cells = {make_sweep_cell({}), make_sweep_cell({"cubes", "mine"}),
                                            make_sweep_cell({"cubes", "vsm"})};
  cells[1].cost.fetches.reset();
  cells[1].absent["cost.fetches"] = "the filter reads the map's samplers itself";
  cells[2].error.rmse.reset();
  cells[2].absent["error"] = "no truth";
  const TradeScope scope = make_trade_scopes(cells)[0];
  const TradeFront front = make_trade_front(scope, 0, 2);
  EXPECT_THAT(front.configurations, ElementsAre(0));
  EXPECT_THAT(describe_front(scope, front, make_run().gl),
              ::testing::IsSupersetOf({"Left out: 1 of 3 (cost.fetches: the filter reads the map's samplers itself).",
                                       "Left out: 1 of 3 (error.rmse: no truth)."}));
}

TEST(TradeFronts, CompareKernelsOfOneClass) {
  std::vector<records::CellRecord> cells = {
      make_sweep_cell({"cubes", "none", 0.0, 1.0, 0.0, 0.1}), make_sweep_cell({"cubes", "slow", 0.0, 2.0, 0.0, 0.2}),
      make_sweep_cell({"cubes", "narrow", 0.0, 3.0, 0.0, 0.3}), make_sweep_cell({"cubes", "mine", 0.0, 4.0, 0.0, 0.4})};
  cells[2].kernel = {0.41, "sharp"};
  cells[3].kernel = {};
  const TradeScope scope = make_trade_scopes(cells)[0];
  const TradeFront front = make_trade_front(scope, 0, 0);
  EXPECT_THAT(front.members, ElementsAre(2, 0)) << "narrow kernels first";
  EXPECT_EQ(front.placements[1].by, 0u);
  EXPECT_THAT(describe_front(scope, front, make_run().gl),
              ElementsAre(HasSubstr("sharp kernels, the front from the cheapest cell on: narrow (0.3"),
                          HasSubstr("medium kernels, the front from the cheapest cell on: none (0.1"),
                          "Dominated are 1 of 4: none beats slow.",
                          "Compared with nothing, for their kernels are of no class, too wide or unknown: mine."));
  EXPECT_THAT(pages::make_fronts_csv(cells, {scope}), HasSubstr(",,,,its kernel is of no class of width\r\n"));
}

TEST(TradeFronts, ValuesThatAreNotFinite_AreLeftOut) {
  records::CellRecord cell = make_sweep_cell({});
  cell.error.rmse = std::nan("");
  EXPECT_THAT(make_trade_front(make_trade_scopes({cell})[0], 0, 0).configurations, SizeIs(0));
}

TEST(TradeFronts, OfFewerThanThreeCells_AreNotShown) {
  std::vector<records::CellRecord> cells = {make_sweep_cell({}), make_sweep_cell({"cubes", "vsm"})};
  EXPECT_FALSE(has_trade(make_trade_scopes(cells)));
  cells.push_back(make_sweep_cell({"cubes", "esm"}));
  EXPECT_TRUE(has_trade(make_trade_scopes(cells)));
  cells[2].error = {};
  EXPECT_FALSE(has_trade(make_trade_scopes(cells)));
}

TEST(FrontWords, SayMembersTiesAndWhatTheyBeat) {
  const std::vector<records::CellRecord> cells = {make_sweep_cell({"cubes", "none", 0.0, 1.0, 0.0, 0.1}),
                                                  make_sweep_cell({"cubes", "vsm", 4.0, 2.0, 0.1, 0.05}),
                                                  make_sweep_cell({"cubes", "esm", 4.0, 2.1, 0.1, 0.0505}),
                                                  make_sweep_cell({"cubes", "poisson", 4.0, 4.0, 0.1, 0.08})};
  const TradeScope scope = make_trade_scopes(cells)[0];
  const auto words = describe_front(scope, make_trade_front(scope, 0, 0), make_run().gl);
  ASSERT_THAT(words, SizeIs(3));
  EXPECT_THAT(words[0],
              HasSubstr("none (0.1 [0.099, 0.101] at 4 ms (CPU)); vsm (0.05 [0.049, 0.051] at 8 [7.2, 8.8] ms (CPU))"));
  EXPECT_EQ(words[1], "Not to be told apart in error or cost: vsm is tied with esm.");
  EXPECT_EQ(words[2], "Dominated are 1 of 4: vsm beats poisson.");
}

/// A sweep in which `none` and one `vsm` are the front and all else is dominated.
std::vector<records::CellRecord> make_wide_sweep() {
  std::vector<records::CellRecord> cells = {make_sweep_cell({"cubes", "none", 0.0, 1.0, 0.0, 0.1}),
                                            make_sweep_cell({"cubes", "pcf2x2", 0.0, 1.5, 0.0, 0.1})};
  for (int i = 0; i < 5; ++i) {
    const double more = 0.1 * i;
    cells.push_back(make_sweep_cell({"cubes", "vsm", 1.0 + i, 2.0 + more, 0.0, 0.05}));
    cells.push_back(make_sweep_cell({"cubes", "esm", 1.0 + i, 1.2 + more, 0.0, 0.2 + more}));
  }
  cells.push_back(make_sweep_cell({"cubes", "poisson", 4.0, 1.0, 0.0, 0.3}));
  return cells;
}

TEST(FrontWords, ManyDominated_AreCountedByFilterWithTheReason) {
  const TradeScope scope = make_trade_scopes(make_wide_sweep())[0];
  const auto words = describe_front(scope, make_trade_front(scope, 0, 0), make_run().gl);
  ASSERT_THAT(words, SizeIs(2));
  EXPECT_EQ(words[1],
            "Dominated are 11 of 13: pcf2x2, 4 of 5 of vsm, all 5 of esm, poisson. Of these, 5 cost more and err more, "
            "5 cost more for "
            "no less error, 1 err more for no less cost. none beats 7, vsm (radius 1) beats 4; fronts.csv has each.");
}

TEST(FrontWords, ManyTied_AreCountedByFilter) {
  std::vector<records::CellRecord> cells = {make_sweep_cell({"cubes", "none", 0.0, 1.0, 0.0, 0.1})};
  for (int i = 0; i < 9; ++i)
    cells.push_back(make_sweep_cell({"cubes", i < 5 ? "vsm" : "esm", 1.0 + i, 1.0, 0.0, 0.1}));
  const TradeScope scope = make_trade_scopes(cells)[0];
  EXPECT_THAT(
      describe_front(scope, make_trade_front(scope, 0, 0), make_run().gl),
      ::testing::Contains(
          "Not to be told apart in error or cost from a cell of the front are 9 of 10: all 5 of vsm, all 4 of esm."));
}

TEST(FrontWords, NeighboursOfUncertainCost_AreNamed) {
  const std::vector<records::CellRecord> cells = {make_sweep_cell({"cubes", "none", 0.0, 1.0, 0.0, 0.1}),
                                                  make_sweep_cell({"cubes", "vsm", 4.0, 1.1, 0.2, 0.05})};
  const TradeScope scope = make_trade_scopes(cells)[0];
  EXPECT_THAT(describe_front(scope, make_trade_front(scope, 0, 0), make_run().gl),
              ::testing::Contains(HasSubstr("may be free: none and vsm.")));
}

TEST(FrontsCsv, HasARowPerCellOfEveryFront) {
  const std::vector<records::CellRecord> cells = {make_sweep_cell({"cubes", "none", 0.0, 1.0, 0.0, 0.1}),
                                                  make_sweep_cell({"cubes", "vsm", 4.0, 2.0, 0.0, 0.2}),
                                                  make_sweep_cell({"cubes", "a,\"b", 4.0, 1.0, 0.0, 0.1})};
  const std::string csv = pages::make_fronts_csv(cells, make_trade_scopes(cells));
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 1 + 16 * 3);
  EXPECT_THAT(
      csv, HasSubstr("rmse,lookup," + cells[1].key +
                     ",vsm,\"{\"\"radius\"\":4}\",1024,4,medium,0.2,0.199,0.201,8,8,8,0," + cells[0].key + ",,\r\n"));
  EXPECT_THAT(csv, HasSubstr(",0,," + cells[0].key + ",\r\n"));
  EXPECT_THAT(csv, HasSubstr("\"a,\"\"b\""));
  EXPECT_THAT(csv, HasSubstr("leak,lookup," + cells[0].key +
                             ",none,\"{\"\"radius\"\":0}\",1024,0,medium,,,,4,4,4,,,,artefact.leak: not measured\r\n"));
}

}  // namespace
}  // namespace shadowbench::analysis
