#include "report/analysis/crossover.h"

#include <gmock/gmock.h>

#include "report/analysis/growth.h"
#include "trade_cells.h"

namespace shadowbench::analysis {

using namespace records;
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

std::vector<WidthChart> make_charts(const std::vector<records::CellRecord>& cells) {
  return make_width_charts(cells, make_trade_scopes(cells));
}

TEST(Crossover, IsFoundWhereTapsGrowDearer) {
  const auto charts = make_charts(make_crossing_cells("cubes"));
  ASSERT_THAT(charts, SizeIs(1));
  const auto comparisons = compare_curves(charts[0], LightState::kStill);
  ASSERT_THAT(comparisons, SizeIs(1));
  EXPECT_THAT(comparisons[0].widths, ElementsAre(2.0, 4.0, 8.0));
  EXPECT_THAT(comparisons[0].signs, ElementsAre(1, -1, -1));
  ASSERT_THAT(comparisons[0].crossings, SizeIs(1));
  EXPECT_NEAR(comparisons[0].crossings[0].sigma_texels, 3.0, 1e-9);  // 1.6 and 2.5 are as far below and above 2
  EXPECT_NEAR(comparisons[0].crossings[0].still.value, 8.0, 1e-9);
  EXPECT_EQ(describe_comparison(comparisons[0]), "from a kernel width of 4 texels on, of 2, 4, 8 compared");
}

TEST(Crossover, WidthsThatNearlyAgree_AreOne) {
  std::vector<records::CellRecord> cells = make_crossing_cells("cubes");
  cells[2].kernel.sigma_texels = 4.03;  // of the taps; the blurred map's is 4
  const auto comparison = compare_curves(make_charts(cells)[0], LightState::kStill)[0];
  EXPECT_THAT(comparison.widths, ElementsAre(2.0, 4.0, 8.0));
  EXPECT_THAT(comparison.signs, ElementsAre(1, -1, -1));
}

TEST(Crossover, OverlappingTimes_AreNotApart) {
  std::vector<records::CellRecord> cells = make_crossing_cells("cubes");
  cells[2].time_ms.filter->ci95 = {7.6, 10.4};
  const auto comparison = compare_curves(make_charts(cells)[0], LightState::kStill)[0];
  EXPECT_THAT(comparison.signs, ElementsAre(1, 0, -1));
  EXPECT_EQ(describe_comparison(comparison),
            "from a kernel width of 8 texels on, of 2, 4, 8 compared, not to be told apart at 4");
}

TEST(Crossover, RadiiOutsideWhatWasMeasured_AreNotCompared) {
  std::vector<records::CellRecord> cells = make_crossing_cells("cubes");
  cells.erase(cells.begin() + 3);  // poisson of radius 8
  const auto charts = make_charts(cells);
  EXPECT_THAT(compare_curves(charts[0], LightState::kStill)[0].widths, ElementsAre(2.0, 4.0));
  EXPECT_FALSE(time_at(charts[0].curves[1], 8.0, LightState::kStill));
  EXPECT_FALSE(time_at(charts[0].curves[1], 1.0, LightState::kStill));
  EXPECT_NEAR(time_at(charts[0].curves[1], 3.0, LightState::kStill)->value, 8.0, 1e-9);
}

TEST(Crossover, WithoutACommonWidth_NothingIsSaid) {
  const std::vector<records::CellRecord> cells = {make_sweep_cell({}), make_taps_cell("cubes", 3.0, 2.0),
                                                  make_blurred_cell("cubes", 4.0, 2.0)};
  EXPECT_THAT(make_charts(cells), IsEmpty());
  EXPECT_THAT(describe_crossovers(make_charts(cells)), IsEmpty());
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

TEST(Crossover, Words_NameThePlacesOnce) {
  std::vector<records::CellRecord> cells = make_crossing_cells("cubes");
  for (const records::CellRecord& cell : make_crossing_cells("stack")) cells.push_back(cell);
  const auto words = describe_crossovers(make_charts(cells));
  ASSERT_THAT(words, SizeIs(2));
  EXPECT_EQ(
      words[0],
      "Light still (lookup): vsm is cheaper than poisson from a kernel width of 4 texels on, of 2, 4, 8 compared: "
      "cubes, stack, picture 960 × 540, map 1024.");
  EXPECT_THAT(words[1], HasSubstr("Light moving"));
}

TEST(Crossover, Words_NameASceneOnce_UnderHoweverManyLights) {
  std::vector<records::CellRecord> cells;
  for (const char* scene : {"stack", "cubes"}) {
    for (const char* light : {"scene", "10,20", "30,40"}) {
      for (records::CellRecord cell : make_crossing_cells(scene)) {
        cell.light = light;
        cells.push_back(cell);
      }
    }
  }
  EXPECT_THAT(describe_crossovers(make_charts(cells))[0],
              HasSubstr(": stack (3 settings), cubes (3 settings), picture 960 × 540, map 1024."));
}

TEST(Growth, Exponent_IsTheSlopeOfLogarithms) {
  EXPECT_NEAR(fit_exponent({{1.0, 3.0}, {4.0, 6.0}, {16.0, 12.0}}), 0.5, 1e-12);
}

TEST(Growth, IsSaidOnlyOfSizesThatWereMeasured) {
  std::vector<records::CellRecord> cells = {make_cell("cubes", "vsm", 2.0), make_cell("cubes", "vsm", 8.0)};
  EXPECT_THAT(describe_growth(cells), IsEmpty());
  cells[1].width *= 2;
  cells[1].height *= 2;
  const auto words = describe_growth(cells);
  ASSERT_THAT(words, SizeIs(1));
  EXPECT_THAT(words[0], HasSubstr("the picture, from 518400 to 2073600 pixels"));
  EXPECT_THAT(words[0], HasSubstr(": vsm 1.00."));
}

TEST(Growth, OfPrefilterAndLookup_IsOverTheMap) {
  std::vector<records::CellRecord> cells = {make_cell("cubes", "vsm", 2.0), make_cell("cubes", "vsm", 2.0),
                                            make_cell("stack", "vsm", 2.0), make_cell("stack", "vsm", 4.0)};
  for (const std::size_t i : {1u, 3u}) cells[i].map_size = 2048;
  cells[0].time_ms.prefilter = records::Quartiles{1.0, 1.0, 1.0, 5};
  cells[1].time_ms.prefilter = records::Quartiles{4.0, 4.0, 4.0, 5};
  const auto words = describe_growth(cells);
  ASSERT_THAT(words, SizeIs(2));
  EXPECT_THAT(words[0], HasSubstr("lookup grows with the map, from 1048576 to 4194304 texels"));
  EXPECT_THAT(words[0], HasSubstr("vsm 0.25, 0.00 to 0.50 in 2 series."));
  EXPECT_THAT(words[1], HasSubstr(": vsm 1.00."));
}

}  // namespace
}  // namespace shadowbench::analysis
