#include <gmock/gmock.h>

#include "report/analysis/cost_curves.h"
#include "report/pages/trade_section.h"
#include "report/pages/write_report.h"
#include "report/records/format.h"
#include "report/records/json_io.h"
#include "report/records/text_table.h"
#include "trade_cells.h"

namespace shadowbench::analysis {

using namespace records;
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using ::testing::SizeIs;

/// Times per count, as ratios to a reference of `count` ms still and 2 `count` ms moving, known to 1 %.
struct LitTimes {
  std::vector<double> still;
  std::vector<double> moving;
};

constexpr int kCounts[] = {1, 2, 4, 8};

records::Ratio make_ratio(double value) {
  return value == 1.0 ? records::Ratio{1.0, {1.0, 1.0}} : records::Ratio{value, {0.99 * value, 1.01 * value}};
}

records::CellRecord make_lit_cell(const std::string& filter, const LitTimes& times, int map_size = 1024) {
  records::CellRecord cell = make_sweep_cell(
      {"cubes", filter, 4.0, filter == "none" ? 1.0 : 2.0, filter == "none" ? 0.0 : 0.01, 0.1, map_size});
  cell.lights.emplace();
  for (std::size_t i = 0; i < times.still.size(); ++i) {
    const double count = kCounts[i], still = times.still[i] * count, moving = 2.0 * times.moving[i] * count;
    // Medians drift; ratios do not.
    const double drift = filter == "none" ? 1.0 : 1.1;
    cell.lights->push_back({kCounts[i],
                            {drift * still, drift * still - 0.5, drift * still + 0.5, 9},
                            {drift * moving, drift * moving - 0.5, drift * moving + 0.5, 9},
                            make_ratio(times.still[i]),
                            make_ratio(times.moving[i]),
                            kCounts[i] * 4194304});
  }
  return cell;
}

/// Poisson is dear still; the prefilter of vsm is dear moving; esm becomes cheaper than vsm with many lights.
std::vector<records::CellRecord> make_lit_cells(int map_size = 1024) {
  return {make_lit_cell("none", {{1, 1, 1, 1}, {1, 1, 1, 1}}, map_size),
          make_lit_cell("poisson", {{3, 3, 3, 3}, {2, 2, 2, 2}}, map_size),
          make_lit_cell("vsm", {{1.5, 1.5, 1.5, 1.5}, {4, 4, 4, 4}}, map_size),
          make_lit_cell("esm", {{1.6, 1.501, 1.4, 1.4}, {4.5, 4.5, 4.5, 4.5}}, map_size)};
}

std::vector<CostChart> make_lit_charts(const std::vector<records::CellRecord>& cells) {
  return make_light_charts(cells, make_trade_scopes(cells));
}

TEST(LightGrowth, Times_AreRatiosTimesTheReference) {
  const auto charts = make_lit_charts(make_lit_cells());
  ASSERT_THAT(charts, SizeIs(1));
  EXPECT_EQ(charts[0].title, "cubes · view main · 960 × 540 · map 1024");
  EXPECT_THAT(list_measured(charts), ElementsAre(1.0, 2.0, 4.0, 8.0));
  const CurvePoint& point = charts[0].curves[2].points[3];
  EXPECT_EQ(point.at, 8.0);
  EXPECT_NEAR(point.cost.static_light.value, 12.0, 1e-9);
  EXPECT_NEAR(point.cost.static_light.low, 0.99 * 12.0, 1e-9);
  EXPECT_NEAR(point.cost.moving.high, 1.01 * 64.0, 1e-9);
  EXPECT_EQ(charts[0].curves[2].maps_bytes, 8 * 4194304);
}

TEST(LightGrowth, WithoutTheReference_TimesAreMediansAndQuartiles) {
  std::vector<records::CellRecord> cells = make_lit_cells();
  cells.erase(cells.begin());
  const CurvePoint point = make_lit_charts(cells)[0].curves[1].points[3];
  EXPECT_NEAR(point.cost.static_light.value, 1.1 * 12.0, 1e-9);
  EXPECT_NEAR(point.cost.static_light.low, 1.1 * 12.0 - 0.5, 1e-9);
}

TEST(LightGrowth, IsTheSlopeAndTheExponent) {
  const CostCurve curve{
      "vsm",
      "vsm",
      {{1, {}, {{2, 2, 2}, {3, 3, 3}}}, {4, {}, {{4, 4, 4}, {9, 9, 9}}}, {16, {}, {{8, 8, 8}, {33, 33, 33}}}}};
  EXPECT_NEAR(find_light_growth(curve, LightMotion::kStatic).per_light_ms.value, 2.0, 1e-12);
  EXPECT_EQ(find_light_growth(curve, LightMotion::kStatic).per_light_ms.low,
            find_light_growth(curve, LightMotion::kStatic).per_light_ms.high);
  EXPECT_NEAR(find_light_growth(curve, LightMotion::kMoving).exponent.value, 0.5, 1e-12);
}

/// No times within the quartiles give a slope or an exponent outside.
TEST(LightGrowth, HasTheIntervalThatQuartilesAllow) {
  const CostCurve curve{"vsm", "vsm", {{1, {}, {{}, {2, 1, 4}}}, {4, {}, {{}, {8, 4, 16}}}}};
  const LightGrowth growth = find_light_growth(curve, LightMotion::kStatic);
  EXPECT_NEAR(growth.per_light_ms.value, 2.0, 1e-12);
  EXPECT_NEAR(growth.per_light_ms.low, 0.0, 1e-12);
  EXPECT_NEAR(growth.per_light_ms.high, 5.0, 1e-12);
  EXPECT_NEAR(growth.exponent.value, 1.0, 1e-12);
  EXPECT_NEAR(growth.exponent.low, 0.0, 1e-12);
  EXPECT_NEAR(growth.exponent.high, 2.0, 1e-12);
}

/// 3, 6 and 15 ms under 1, 2 and 4 lights: the line 8 + 57 / 14 (n - 7 / 3) is 0.57 ms above the first.
TEST(LightGrowth, TellsHowFarTimesAreFromALine) {
  CostCurve curve{"vsm", "vsm", {{1, {}, {{}, {3, 3, 3}}}, {2, {}, {{}, {6, 6, 6}}}, {4, {}, {{}, {15, 15, 15}}}}};
  EXPECT_NEAR(*find_light_growth(curve, LightMotion::kStatic).off_line,
              std::abs(8.0 - 57.0 / 14.0 * 4.0 / 3.0 - 3.0) / 3.0, 1e-12);
  curve.points[2].spread.static_light = {12, 12, 12};
  EXPECT_NEAR(*find_light_growth(curve, LightMotion::kStatic).off_line, 0.0, 1e-12);
  curve.points.pop_back();
  EXPECT_EQ(find_light_growth(curve, LightMotion::kStatic).off_line, std::nullopt) << "two points are always on a line";
}

TEST(LightGrowth, IsSaidInASentence_WithItsClock) {
  EXPECT_EQ(summarize_lights(make_lit_charts(make_lit_cells()), make_run().gl),
            "Each further light costs 1 ms (CPU) (none, casters static, cubes · view main · 960 × 540 · map 1024) to "
            "9.9 (esm, casters moving, cubes · view main · 960 × 540 · map 1024); 3 of 6 pairs of filters change "
            "order between numbers of lights, or between casters that stand still and that move.");
}

TEST(LightGrowth, OfAllPlaces_IsInOneTable_AndWhereItIsNotLinear) {
  std::vector<records::CellRecord> cells = make_lit_cells();
  for (records::CellRecord cell : make_lit_cells()) {
    cell.scene = "bulb";
    if (cell.filter == "vsm") cell.lights->back().static_ms.median *= 2.0;
    cells.push_back(cell);
  }
  const auto row_of = [&](std::size_t row) { return make_light_table(make_lit_charts(cells)).rows.at(row); };
  EXPECT_THAT(row_of(4)[2], HasSubstr("cubes"));
  EXPECT_THAT(row_of(4)[7], HasSubstr("1.65 ["));
  EXPECT_EQ(row_of(4)[9], "0.0 %");
  EXPECT_THAT(row_of(12)[2], HasSubstr("bulb"));
  EXPECT_THAT(row_of(12)[7], HasSubstr("3.6 ["));
  EXPECT_EQ(row_of(12)[9], "125.2 %");
  for (records::CellRecord& cell : cells) cell.lights->resize(2);
  EXPECT_EQ(row_of(4)[7], records::kNothing) << "two counts are always on a line";
}

TEST(LightGrowth, OfOneCount_IsNotSaid) {
  std::vector<records::CellRecord> cells = make_lit_cells();
  for (records::CellRecord& cell : cells) cell.lights->resize(1);
  EXPECT_EQ(summarize_lights(make_lit_charts(cells), make_run().gl), "");
  const document::Section section = pages::make_trade_section(make_run(), cells, *pages::make_trade(cells));
  for (const document::Block& block : section.blocks) {
    const auto* choice = std::get_if<document::ChartChoice>(&block);
    EXPECT_FALSE(choice && choice->id == "lights");
  }
  EXPECT_EQ(make_light_table(make_lit_charts(cells)).rows[0][4], records::kNothing);
}

TEST(LightOrder, OverlappingTimes_AreNotApart) {
  const auto comparisons = compare_curves(make_lit_charts(make_lit_cells())[0]);
  ASSERT_THAT(comparisons, SizeIs(6));
  const CurveComparison& vsm_esm = comparisons[5];
  EXPECT_THAT(vsm_esm.at, ElementsAre(1.0, 2.0, 4.0, 8.0));
  EXPECT_THAT(vsm_esm.signs.static_light, ElementsAre(-1, 0, 1, 1));
  EXPECT_THAT(vsm_esm.signs.moving, ElementsAre(-1, -1, -1, -1));
  EXPECT_TRUE(vsm_esm.changes());
  EXPECT_FALSE(comparisons[0].changes());
}

TEST(LightOrder, TableHasWhereOneOvertakesAnother_AndNoMore) {
  const records::TextTable table = make_comparison_table(make_lit_charts(make_lit_cells()));
  constexpr const char* kWhere = "cubes · view main · 960 × 540 · map 1024";
  EXPECT_THAT(table.header, ElementsAre("filter", "other filter", "where", "lights compared",
                                        "static, the first is cheaper at", "static, the first is dearer at",
                                        "moving, the first is cheaper at", "moving, the first is dearer at"));
  ASSERT_THAT(table.rows, SizeIs(3));
  EXPECT_THAT(table.rows[0], ElementsAre("poisson", "vsm", kWhere, "1, 2, 4, 8", records::kNothing, "1, 2, 4, 8",
                                         "1, 2, 4, 8", records::kNothing));
  EXPECT_THAT(table.rows[1][1], "esm");
  EXPECT_THAT(table.rows[2],
              ElementsAre("vsm", "esm", kWhere, "1, 2, 4, 8", "1", "4, 8", "1, 2, 4, 8", records::kNothing));
}

TEST(LightOrder, OfNumbersThatOneLacks_IsNotSaid) {
  const std::vector<records::CellRecord> cells = {make_lit_cell("none", {{1, 1, 1, 1}, {1, 1, 1, 1}}),
                                                  make_lit_cell("vsm", {{2, 2}, {2, 2}}),
                                                  make_lit_cell("esm", {{3, 3, 3}, {1.5, 1.5, 1.5}})};
  EXPECT_EQ(make_comparison_table(make_lit_charts(cells)).rows.at(0)[3], "1, 2");
}

TEST(LightOrder, WhereNothingChanges_TheTableIsEmpty_OnEveryMap) {
  std::vector<records::CellRecord> cells;
  for (const int map_size : {512, 1024}) {
    cells.push_back(make_lit_cell("none", {{1, 1}, {1, 1}}, map_size));
    cells.push_back(make_lit_cell("vsm", {{2, 2}, {2, 2}}, map_size));
    cells.push_back(make_lit_cell("esm", {{2.01, 2.01}, {2.01, 2.01}}, map_size));
  }
  EXPECT_THAT(make_comparison_table(make_lit_charts(cells)).rows, IsEmpty());
  EXPECT_THAT(summarize_lights(make_lit_charts(cells), make_run().gl), HasSubstr("; 0 of 6 pairs of filters change"));
}

TEST(LightCharts, HoldOnlyWhatWasTimed_WithParametersThatTell) {
  std::vector<records::CellRecord> cells = make_lit_cells();
  cells[3].lights.reset();
  cells.push_back(make_lit_cell("vsm", {{2, 2}, {2, 2}}));
  cells.back().params["radius"] = 8.0;
  cells.push_back(make_lit_cell("none", {{1}, {1}}, 2048));
  const auto charts = make_lit_charts(cells);
  ASSERT_THAT(charts, SizeIs(2));
  ASSERT_THAT(charts[0].curves, SizeIs(4));
  EXPECT_EQ(charts[0].curves[0].label, "none");
  EXPECT_EQ(charts[0].curves[2].label, "vsm (radius 4)");
  EXPECT_EQ(charts[0].curves[3].label, "vsm (radius 8)");
  EXPECT_EQ(make_light_table({charts[0]}).rows[6][5], records::kNothing) << "4 lights were not timed with it";
  for (records::CellRecord& cell : cells) cell.lights.reset();
  EXPECT_THAT(make_lit_charts(cells), IsEmpty());
}

TEST(LightTable, HasBothStates) {
  const records::TextTable table = make_light_table(make_lit_charts(make_lit_cells()));
  EXPECT_THAT(table.header,
              ElementsAre("filter", "casters", "where", "1 light", "2 lights", "4 lights", "8 lights",
                          "ms per added light", "exponent", "off a line", "MiB of maps at the most lights"));
  ASSERT_THAT(table.rows, SizeIs(8));
  EXPECT_THAT(table.rows[4], ElementsAre("vsm", "static", "cubes · view main · 960 × 540 · map 1024",
                                         "1.5 [1.48, 1.52]", "3 [2.97, 3.03]", "6 [5.94, 6.06]", "12 [11.9, 12.1]",
                                         "1.65 [1.49, 1.81]", "1.00 [0.84, 1.21]", "0.0 %", "32"));
  EXPECT_THAT(table.rows[5][1], "moving");
  EXPECT_THAT(table.rows[5][6], HasSubstr("64 ["));
}

std::filesystem::path write(const TemporaryFolder& folder, const std::vector<records::CellRecord>& cells) {
  std::vector<std::string> keys;
  for (const records::CellRecord& cell : cells) {
    records::write_cell(folder.path(), cell);
    keys.push_back(cell.key);
  }
  pages::write_report(folder.path(), make_run(), keys);
  return folder.path();
}

TEST(LightSection, ShowsChartTableAndSentence) {
  const TemporaryFolder folder("light_section");
  const auto out = write(folder, make_lit_cells());
  const std::string page = read_text(out / "index.html"), summary = read_text(out / "summary.md");
  for (const char* text :
       {"with its lights</h3>", "Filters that change order", "Each further light costs",
        "time of a frame, ms: CPU time (software rasteriser)", "<figure class=\"chart\" id=\"lights\">",
        "cubes.main.960x540.map1024.lights.moving", "lights, each with a map of its own", "in proportion"})
    EXPECT_THAT(page, HasSubstr(text));
  for (const char* text :
       {"3 of 6 pairs of filters change order", "| vsm     | static  | cubes ", "| 1.5 \\[1.48, 1.52\\] "})
    EXPECT_THAT(summary, HasSubstr(text));
}

/// Too few cells for a front, or none with an error: lights are there all the same.
TEST(LightSection, NeedsNoFront) {
  const TemporaryFolder folder("light_no_front");
  std::vector<records::CellRecord> cells = make_lit_cells();
  cells.resize(2);
  const auto out = write(folder, cells);
  const std::string page = read_text(out / "index.html");
  EXPECT_THAT(page, HasSubstr("with its lights</h3>"));
  EXPECT_THAT(page, HasSubstr("map1024.lights"));
  EXPECT_THAT(page, Not(HasSubstr("fronts.csv")));
  EXPECT_FALSE(std::filesystem::exists(out / "fronts.csv"));
  EXPECT_THAT(read_text(out / "summary.md"), AllOf(HasSubstr("| poisson | static "), Not(HasSubstr("fronts.csv"))));
}

TEST(LightSection, IsNotThere_WhereNothingWasTimed) {
  const auto cells = make_crossing_cells("cubes");
  const document::Page page{"", {pages::make_trade_section(make_run(), cells, *pages::make_trade(cells))}, {}};
  EXPECT_THAT(document::write_markdown(page), Not(HasSubstr("with its lights")));
}

}  // namespace
}  // namespace shadowbench::analysis
