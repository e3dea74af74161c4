#include "report/analysis/cost_curves.h"

#include <gmock/gmock.h>

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
  return cell;
}

TEST(MapFamilies, HoldTheMapsOfOneFilterInOnePlace) {
  const std::vector<CellRecord> cells = {make_map_cell("tight", 2048),        make_map_cell("tight", 1024),
                                         make_map_cell("view", 1024),         make_map_cell("tight", 1024, "esm"),
                                         make_map_cell("view", 512, "esm"),   make_map_cell("tight", 1024, "none"),
                                         make_map_cell("tight", 2048, "none")};
  const auto families = list_map_families(cells);
  ASSERT_THAT(families, SizeIs(2)) << "none has one fit alone";
  EXPECT_EQ(families[0].title, "vsm on avenue");
  ASSERT_THAT(families[0].maps, SizeIs(3));
  EXPECT_EQ(families[0].maps[0].size, 1024);
  EXPECT_EQ(families[0].maps[1].fit, "view fit");
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
  EXPECT_THAT(list_map_families(cells), IsEmpty());
}

}  // namespace
}  // namespace shadowbench::analysis
