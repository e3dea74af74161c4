#include <gmock/gmock.h>

#include "report/analysis/cost_curves.h"
#include "trade_cells.h"

namespace shadowbench::analysis {

using namespace records;
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

std::vector<CostChart> make_charts(const std::vector<records::CellRecord>& cells) {
  return make_width_charts(cells, make_trade_scopes(cells));
}

TEST(Crossover, IsFoundWhereTapsGrowDearer) {
  const auto charts = make_charts(make_crossing_cells("cubes"));
  ASSERT_THAT(charts, SizeIs(1));
  const auto comparisons = compare_curves(charts[0]);
  ASSERT_THAT(comparisons, SizeIs(1));
  EXPECT_THAT(comparisons[0].at, ElementsAre(2.0, 4.0, 8.0));
  EXPECT_THAT(comparisons[0].signs.static_light, ElementsAre(1, -1, -1));
  ASSERT_THAT(comparisons[0].crossings.static_light, SizeIs(1));
  const auto [width, cost] = comparisons[0].crossings.static_light[0];
  EXPECT_NEAR(width, 3.0, 1e-9);  // 1.6 and 2.5 are as far below and above 2
  EXPECT_NEAR(cost, 8.0, 1e-9);
  EXPECT_THAT(
      make_comparison_table(charts).rows.at(0),
      ElementsAre("vsm", "poisson", "cubes · view main · 960 × 540 · map 1024", "2, 4, 8", "4, 8", "2", "4, 8", "2"));
}

TEST(Crossover, WidthsThatNearlyAgree_AreOne) {
  std::vector<records::CellRecord> cells = make_crossing_cells("cubes");
  cells[2].kernel.sigma_texels = 4.03;  // of the taps; the blurred map's is 4
  const auto comparison = compare_curves(make_charts(cells)[0])[0];
  EXPECT_THAT(comparison.at, ElementsAre(2.0, 4.0, 8.0));
  EXPECT_THAT(comparison.signs.static_light, ElementsAre(1, -1, -1));
}

TEST(Crossover, OverlappingTimes_AreNotApart) {
  std::vector<records::CellRecord> cells = make_crossing_cells("cubes");
  cells[2].time_ms.static_light->ci95 = {7.6, 10.4};
  const auto comparison = compare_curves(make_charts(cells)[0])[0];
  EXPECT_THAT(comparison.signs.static_light, ElementsAre(1, 0, -1));
  const auto row = make_comparison_table(make_charts(cells)).rows.at(0);
  EXPECT_EQ(row[4], "8") << "not to be told apart at 4";
  EXPECT_EQ(row[5], "2");
}

TEST(Crossover, RadiiOutsideWhatWasMeasured_AreNotCompared) {
  std::vector<records::CellRecord> cells = make_crossing_cells("cubes");
  cells.erase(cells.begin() + 3);  // poisson of radius 8
  const auto charts = make_charts(cells);
  EXPECT_THAT(compare_curves(charts[0])[0].at, ElementsAre(2.0, 4.0));
  EXPECT_FALSE(cost_at(charts[0].curves[1], 8.0, LightMotion::kStatic));
  EXPECT_FALSE(cost_at(charts[0].curves[1], 1.0, LightMotion::kStatic));
  EXPECT_NEAR(cost_at(charts[0].curves[1], 3.0, LightMotion::kStatic)->value, 8.0, 1e-9);
}

TEST(Crossover, WithoutACommonWidth_NothingIsSaid) {
  const std::vector<records::CellRecord> cells = {make_sweep_cell({}), make_taps_cell("cubes", 3.0, 2.0),
                                                  make_blurred_cell("cubes", 4.0, 2.0)};
  EXPECT_THAT(make_charts(cells), IsEmpty());
  EXPECT_EQ(summarize_widths(make_charts(cells)), "");
}

TEST(Crossover, MapsAreChartsOfTheirOwn_AndUnknownRadiiAreLeftOut) {
  std::vector<records::CellRecord> cells = make_crossing_cells("cubes");
  for (records::CellRecord cell : make_crossing_cells("cubes")) {
    cell.map_size = 2048;
    cell.kernel.sigma_texels.reset();
    cells.push_back(cell);
  }
  const auto charts = make_charts(cells);
  ASSERT_THAT(charts, SizeIs(1));
  EXPECT_EQ(charts[0].map_size, 1024);
}

TEST(Crossover, OtherParameters_MakeOtherCurves) {
  std::vector<records::CellRecord> cells = make_crossing_cells("cubes");
  for (records::CellRecord& cell : cells) cell.params["taps"] = 16.0;
  for (const double radius : {2.0, 4.0, 8.0}) {
    records::CellRecord cell = make_taps_cell("cubes", radius, 9.0);
    cell.params["taps"] = 32.0;
    cells.push_back(cell);
  }
  const auto charts = make_charts(cells);
  EXPECT_THAT(charts[0].curves, SizeIs(4));
  EXPECT_EQ(charts[0].curves[1].label, "poisson (taps 16)");
  EXPECT_THAT(charts[0].curves[3].points, SizeIs(3));
}

TEST(Crossover, Sentence_CountsComparisonsAndNamesTheNarrowest) {
  std::vector<records::CellRecord> cells = make_crossing_cells("cubes");
  for (const records::CellRecord& cell : make_crossing_cells("stack")) cells.push_back(cell);
  for (std::size_t i = 8; i < 11; ++i)  // taps of stack are never dearer
    cells[i].time_ms.moving = records::OwnTime{{0.1, 0.1, 0.1, 9}, {0.1, 0.1}};
  const auto charts = make_charts(cells);
  EXPECT_EQ(make_comparison_table(charts).rows.size(), 2u);
  EXPECT_EQ(
      summarize_widths(charts),
      "A prefiltered map is cheaper than many taps with a static light in 2 of 2 comparisons, from a kernel width "
      "of 4 texels on at the earliest (vsm against poisson on cubes · view main · 960 × 540 · map 1024); with a "
      "moving light in 1 of 2 comparisons, from a kernel width of 4 texels on at the earliest (vsm against "
      "poisson on cubes · view main · 960 × 540 · map 1024).");
}

TEST(Growth, Exponent_IsTheSlopeOfLogarithms) {
  EXPECT_NEAR(fit_exponent({{1.0, 3.0}, {4.0, 6.0}, {16.0, 12.0}}), 0.5, 1e-12);
}

TEST(Growth, HasOnlySizesThatWereMeasured) {
  std::vector<records::CellRecord> cells = {make_cell("cubes", "vsm", 2.0), make_cell("cubes", "vsm", 8.0)};
  EXPECT_THAT(make_growth_table(cells).header, ElementsAre("filter"));
  cells[1].width *= 2;
  cells[1].height *= 2;
  const records::TextTable table = make_growth_table(cells);
  EXPECT_THAT(table.header, ElementsAre("filter", "lookup over the picture, 518400 to 2073600 pixels"));
  EXPECT_THAT(table.rows, ElementsAre(ElementsAre("vsm", "1.00")));
}

TEST(Growth, OfPrefilterAndLookup_IsOverTheMap) {
  std::vector<records::CellRecord> cells = {make_cell("cubes", "vsm", 2.0), make_cell("cubes", "vsm", 2.0),
                                            make_cell("stack", "vsm", 2.0), make_cell("stack", "vsm", 4.0)};
  for (const std::size_t i : {1u, 3u}) cells[i].map_size = 2048;
  cells[0].time_ms.prefilter = records::Quartiles{1.0, 1.0, 1.0, 5};
  cells[1].time_ms.prefilter = records::Quartiles{4.0, 4.0, 4.0, 5};
  const records::TextTable table = make_growth_table(cells);
  EXPECT_THAT(table.header, ElementsAre("filter", "lookup over the map, 1048576 to 4194304 texels",
                                        "prefilter over the map, 1048576 to 4194304 texels"));
  EXPECT_THAT(table.rows, ElementsAre(ElementsAre("vsm", "0.25, 0.00 to 0.50 in 2 series", "1.00")));
}

}  // namespace
}  // namespace shadowbench::analysis
