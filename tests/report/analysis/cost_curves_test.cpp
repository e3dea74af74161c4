#include <gmock/gmock.h>

#include "report/analysis/trade.h"
#include "trade_cells.h"

namespace shadowbench::analysis {

using namespace records;
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;
using ::testing::SizeIs;

std::vector<CostChart> make_width_charts_of(const std::vector<CellRecord>& cells) {
  return make_width_charts(cells, make_trade_scopes(cells));
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
  EXPECT_EQ(charts[0].map_size, 1024);
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

CellRecord make_map_cell(const std::string& fit, int size, const std::string& filter = "vsm") {
  CellRecord cell = make_sweep_cell({.scene = "avenue", .filter = filter, .map_size = size});
  cell.fit = fit;
  cell.cost.map_bytes = std::int64_t{4} * size * size;
  return cell;
}

TEST(MapFamilies, HoldTheMapsOfOneFilterInOnePlace) {
  const std::vector<CellRecord> cells = {make_map_cell("tight", 2048),        make_map_cell("tight", 1024),
                                         make_map_cell("view", 1024),         make_map_cell("tight", 1024, "esm"),
                                         make_map_cell("view", 512, "esm"),   make_map_cell("tight", 1024, "none"),
                                         make_map_cell("tight", 2048, "none")};
  const auto families = list_map_families(point_to(cells));
  ASSERT_THAT(families, SizeIs(2)) << "none has one fit alone, and no two fits are common to both";
  EXPECT_EQ(families[0].title, "vsm on avenue");
  ASSERT_THAT(families[0].maps, SizeIs(3));
  EXPECT_EQ(families[0].maps[0].size, 1024);
  EXPECT_EQ(families[0].maps[1].name, "view fit");
  EXPECT_EQ(families[0].maps[2].size, 2048);
  EXPECT_NEAR(families[0].maps[0].cost.value, 4.0, 1e-9);
  EXPECT_NEAR(families[0].maps[0].rmse.value, 0.1, 1e-9);
}

TEST(MapFamilies, WithoutErrorTimesOrTrust_CellsAreLeftOut) {
  std::vector<CellRecord> cells(4, make_map_cell("tight", 1024));
  cells[1].fit = cells[2].fit = cells[3].fit = "view";
  cells[1].error.rmse.reset();
  cells[2].time_ms = {};
  cells[3].status = CellStatus::kSuspect;
  EXPECT_THAT(list_map_families(point_to(cells)), IsEmpty());
}

/// A map of four cascades, as large as one of twice the side.
CellRecord make_cascades(const std::string& split, double rmse, double seam, const std::string& filter = "vsm") {
  CellRecord cell = make_map_cell("cascades:count=4,split=" + split, 1024, filter);
  cell.cost.map_bytes = 4 * *cell.cost.map_bytes - 3;
  cell.error.rmse = rmse;
  cell.artefact.seam = seam;
  return cell;
}

CellRecord with_rmse(CellRecord cell, double rmse) {
  cell.error.rmse = rmse;
  return cell;
}

TEST(BestMap, IsTheLeastWrongOfAsManyBytes_AndOfTiesTheOneWithTheLeastSeam) {
  const std::vector<CellRecord> cells = {with_rmse(make_map_cell("view", 2048), 0.10),
                                         with_rmse(make_map_cell("lispsm", 2048), 0.06),
                                         with_rmse(make_map_cell("lispsm", 1024), 0.08),
                                         with_rmse(make_map_cell("view", 1024), 0.2),
                                         make_cascades("0.5", 0.05, 0.01),
                                         make_cascades("1", 0.0498, 0.03)};
  EXPECT_EQ(
      describe_best_map(list_map_families(point_to(cells))),
      "Best map at 16 MiB: 4 cascades, split 0.5, 1024 texels a side, RMSE 0.05, seam 0.01, tied with 1 other (0.06 "
      "by lispsm fit; 0.1 by view fit); at 4 MiB: lispsm fit, 1024 texels a side, RMSE 0.08.");
  EXPECT_EQ(describe_best_map(list_map_families({&cells[1], &cells[3]})), "") << "nothing has as many bytes";
  const MapFamily family = list_map_families({&cells[0], &cells[4]}).front();
  EXPECT_THAT(family.maps, ElementsAre(testing::Field(&MapPoint::seam, std::optional(0.01)),
                                       testing::Field(&MapPoint::seam, std::nullopt)));
  EXPECT_EQ(describe_best_map(list_map_families({&cells[0], &cells[3]})), "") << "one fit";
}

TEST(BestMap, OfSeveralFilters_TakesTheRootMeanSquareOfTheMapsThatAllHave) {
  const std::vector<CellRecord> cells = {with_rmse(make_map_cell("view", 2048), 0.03), make_cascades("1", 0.04, 0.0),
                                         with_rmse(make_map_cell("view", 2048, "esm"), 0.05),
                                         make_cascades("1", 0.01, 0.0, "esm"), make_cascades("0.5", 0.001, 0.0)};
  const auto families = list_map_families(point_to(cells));
  ASSERT_THAT(families, SizeIs(3));
  EXPECT_EQ(families[0].title, "all filters");
  ASSERT_THAT(families[0].maps, SizeIs(2)) << "esm was not measured with a split of 0.5";
  EXPECT_NEAR(families[0].maps[0].rmse.value, std::sqrt(0.5 * (0.04 * 0.04 + 0.01 * 0.01)), 1e-9);
  EXPECT_THAT(describe_best_map(list_map_families(point_to(cells))),
              testing::StartsWith("Best map at 16 MiB: 4 cascades, split 1,"));
}

}  // namespace
}  // namespace shadowbench::analysis
