#include "report/analysis/light_growth.h"

#include <gmock/gmock.h>

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

std::vector<LightChart> make_lit_charts(const std::vector<records::CellRecord>& cells) {
  return make_light_charts(cells, make_trade_scopes(cells));
}

TEST(LightGrowth, Times_AreRatiosTimesTheReference) {
  const auto charts = make_lit_charts(make_lit_cells());
  ASSERT_THAT(charts, SizeIs(1));
  EXPECT_EQ(charts[0].title, "cubes · view main · 960 × 540 · map 1024");
  EXPECT_THAT(charts[0].counts, ElementsAre(1, 2, 4, 8));
  const LightPoint& point = charts[0].curves[2].points[3];
  EXPECT_EQ(point.count, 8);
  EXPECT_NEAR(point.still.value, 12.0, 1e-9);
  EXPECT_NEAR(point.still.low, 0.99 * 12.0, 1e-9);
  EXPECT_NEAR(point.moving.high, 1.01 * 64.0, 1e-9);
  EXPECT_EQ(point.maps_bytes, 8 * 4194304);
}

TEST(LightGrowth, WithoutTheReference_TimesAreMediansAndQuartiles) {
  std::vector<records::CellRecord> cells = make_lit_cells();
  cells.erase(cells.begin());
  const LightPoint point = make_lit_charts(cells)[0].curves[1].points[3];
  EXPECT_NEAR(point.still.value, 1.1 * 12.0, 1e-9);
  EXPECT_NEAR(point.still.low, 1.1 * 12.0 - 0.5, 1e-9);
}

TEST(LightGrowth, IsTheSlopeAndTheExponent) {
  const LightCurve curve{"vsm",
                         "vsm",
                         {{1, {}, {}, {3, 3, 3}, {2, 2, 2}, 0},
                          {4, {}, {}, {9, 9, 9}, {4, 4, 4}, 0},
                          {16, {}, {}, {33, 33, 33}, {8, 8, 8}, 0}}};
  EXPECT_NEAR(find_light_growth(curve, LightState::kStill).per_light_ms.value, 2.0, 1e-12);
  EXPECT_EQ(find_light_growth(curve, LightState::kStill).per_light_ms.low,
            find_light_growth(curve, LightState::kStill).per_light_ms.high);
  EXPECT_NEAR(find_light_growth(curve, LightState::kMoving).exponent.value, 0.5, 1e-12);
}

/// No times within the quartiles give a slope or an exponent outside.
TEST(LightGrowth, HasTheIntervalThatQuartilesAllow) {
  const LightCurve curve{"vsm", "vsm", {{1, {}, {}, {2, 1, 4}, {}, 0}, {4, {}, {}, {8, 4, 16}, {}, 0}}};
  const LightGrowth growth = find_light_growth(curve, LightState::kStill);
  EXPECT_NEAR(growth.per_light_ms.value, 2.0, 1e-12);
  EXPECT_NEAR(growth.per_light_ms.low, 0.0, 1e-12);
  EXPECT_NEAR(growth.per_light_ms.high, 5.0, 1e-12);
  EXPECT_NEAR(growth.exponent.value, 1.0, 1e-12);
  EXPECT_NEAR(growth.exponent.low, 0.0, 1e-12);
  EXPECT_NEAR(growth.exponent.high, 2.0, 1e-12);
}

/// 3, 6 and 15 ms under 1, 2 and 4 lights: the line 8 + 57 / 14 (n - 7 / 3) is 0.57 ms above the first.
TEST(LightGrowth, TellsHowFarTimesAreFromALine) {
  LightCurve curve{
      "vsm", "vsm", {{1, {}, {}, {3, 3, 3}, {}, 0}, {2, {}, {}, {6, 6, 6}, {}, 0}, {4, {}, {}, {15, 15, 15}, {}, 0}}};
  EXPECT_NEAR(*find_light_growth(curve, LightState::kStill).off_line,
              std::abs(8.0 - 57.0 / 14.0 * 4.0 / 3.0 - 3.0) / 3.0, 1e-12);
  curve.points[2].still_spread = {12, 12, 12};
  EXPECT_NEAR(*find_light_growth(curve, LightState::kStill).off_line, 0.0, 1e-12);
  curve.points.pop_back();
  EXPECT_EQ(find_light_growth(curve, LightState::kStill).off_line, std::nullopt) << "two points are always on a line";
}

TEST(LightGrowth, IsSaidOfEveryFilter_StillAndMoving_WithItsClock) {
  const auto words = describe_light_growth(make_lit_charts(make_lit_cells()), make_run().gl);
  ASSERT_THAT(words, SizeIs(8));
  EXPECT_EQ(words[1],
            "Each further light costs 3.3 ms (CPU) on cubes with poisson, casters still: linear within 0.0 % (1 to 8 "
            "lights, picture 960 × 540, map 1024).");
  EXPECT_THAT(words[6], HasSubstr("costs 8.8 ms (CPU) on cubes with vsm, casters moving"));
}

TEST(LightGrowth, IsSaidOfAllPlacesInOneSentence_AndWhereItIsNotLinear) {
  std::vector<records::CellRecord> cells = make_lit_cells();
  for (records::CellRecord cell : make_lit_cells()) {
    cell.scene = "bulb";
    if (cell.filter == "vsm") cell.lights->back().still_ms.median *= 2.0;
    cells.push_back(cell);
  }
  const auto words = describe_light_growth(make_lit_charts(cells), make_run().gl);
  ASSERT_THAT(words, SizeIs(8));
  EXPECT_EQ(words[2],
            "Each further light costs 1.65 ms (CPU) on cubes, 3.6 on bulb with vsm, casters still: linear within 0.0 % "
            "on cubes; not linear on bulb (125.2 % off a line) (1 to 8 lights, picture 960 × 540, map 1024).");
  for (records::CellRecord& cell : cells) cell.lights->resize(2);
  EXPECT_THAT(describe_light_growth(make_lit_charts(cells), make_run().gl)[2], Not(HasSubstr("linear")));
}

TEST(LightGrowth, OfOneCount_IsNotSaid) {
  std::vector<records::CellRecord> cells = make_lit_cells();
  for (records::CellRecord& cell : cells) cell.lights->resize(1);
  EXPECT_THAT(describe_light_growth(make_lit_charts(cells), make_run().gl), IsEmpty());
  const page::Section section = pages::make_trade_section(make_run(), cells, *pages::make_trade(cells));
  for (const page::Block& block : section.blocks) EXPECT_FALSE(std::holds_alternative<page::Chart>(block));
  EXPECT_EQ(make_light_table(make_lit_charts(cells)[0]).rows[0][3], records::kNothing);
}

TEST(LightOrder, OverlappingTimes_AreNotApart) {
  const auto comparisons = compare_light_curves(make_lit_charts(make_lit_cells())[0]);
  ASSERT_THAT(comparisons, SizeIs(6));
  const LightComparison& vsm_esm = comparisons[5];
  EXPECT_THAT(vsm_esm.counts, ElementsAre(1, 2, 4, 8));
  EXPECT_THAT(vsm_esm.still, ElementsAre(-1, 0, 1, 1));
  EXPECT_THAT(vsm_esm.moving, ElementsAre(-1, -1, -1, -1));
  EXPECT_TRUE(vsm_esm.changes());
  EXPECT_FALSE(comparisons[0].changes());
}

TEST(LightOrder, SaysWhereOneOvertakesAnother_AndNoMore) {
  const auto words = describe_light_order(make_lit_charts(make_lit_cells()));
  ASSERT_THAT(words, SizeIs(4));
  EXPECT_EQ(words[0],
            "esm is cheaper than poisson with casters still at each of 1, 2, 4, 8 lights; with casters moving at none "
            "of 1, 2, 4, 8 lights (dearer at 1, "
            "2, 4, 8): cubes, picture 960 × 540, map 1024.");
  EXPECT_EQ(words[1],
            "vsm is cheaper than esm with casters still at 1 light, of 1, 2, 4, 8 (dearer at 4, 8, not to be told "
            "apart at 2); with casters moving at each "
            "of 1, 2, 4, 8 lights: cubes, picture 960 × 540, map 1024.");
  EXPECT_THAT(words[2], HasSubstr("vsm is cheaper than poisson with casters still at each of"));
  EXPECT_THAT(words[3], HasSubstr("Of 6 pairs of filters, over all numbers of lights, casters still and moving, 3 "
                                  "change order, 3 keep it wherever the two can be told apart:"));
}

TEST(LightOrder, FromAnyNumberOn_IsSaidAsThat) {
  const std::vector<records::CellRecord> cells = {make_lit_cell("none", {{1, 1, 1, 1}, {1, 1, 1, 1}}),
                                                  make_lit_cell("vsm", {{2, 2, 2, 2}, {2, 2, 2, 2}}),
                                                  make_lit_cell("esm", {{2.5, 2.0, 1.5, 1.5}, {2.5, 2.01, 2.0, 1.5}})};
  const auto words = describe_light_order(make_lit_charts(cells));
  ASSERT_THAT(words, SizeIs(2));
  EXPECT_THAT(words[0], HasSubstr("vsm is cheaper than esm with casters still at 1 light, of 1, 2, 4, 8 (dearer at 4, "
                                  "8, not to be told apart at 2)"));
  std::vector<records::CellRecord> turned = cells;
  for (records::LightCountRecord& each : *turned[2].lights) each.still_ratio = make_ratio(each.count > 1 ? 2.5 : 1.5);
  for (records::LightCountRecord& each : *turned[2].lights) each.moving_ratio = make_ratio(each.count > 1 ? 1.5 : 2.5);
  EXPECT_THAT(describe_light_order(make_lit_charts(turned))[0],
              HasSubstr("esm is cheaper than vsm with casters still at 1 light, of 1, 2, 4, 8 (dearer at 2, 4, 8); "
                        "with casters moving from 2 lights on, of 1, 2, 4, 8 (dearer at 1)"));
}

TEST(LightOrder, WhereNothingChanges_ThatIsSaid_OfEveryMapAtOnce) {
  std::vector<records::CellRecord> cells;
  for (const int map_size : {512, 1024}) {
    cells.push_back(make_lit_cell("none", {{1, 1}, {1, 1}}, map_size));
    cells.push_back(make_lit_cell("vsm", {{2, 2}, {2, 2}}, map_size));
    cells.push_back(make_lit_cell("esm", {{2.01, 2.01}, {2.01, 2.01}}, map_size));
  }
  EXPECT_THAT(describe_light_order(make_lit_charts(cells)),
              ElementsAre("Of 3 pairs of filters, over all numbers of lights, casters still and moving, none changes "
                          "its order, 2 keep it wherever the two can be told "
                          "apart, 1 cannot be told apart anywhere: cubes, picture 960 × 540, map 512, 1024."));
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
  EXPECT_EQ(make_light_table(charts[0]).rows[6][4], records::kNothing) << "4 lights were not timed with it";
  for (records::CellRecord& cell : cells) cell.lights.reset();
  EXPECT_THAT(make_lit_charts(cells), IsEmpty());
}

TEST(LightTable, HasBothStates) {
  const records::TextTable table = make_light_table(make_lit_charts(make_lit_cells())[0]);
  EXPECT_THAT(table.header, ElementsAre("filter", "casters", "1 light", "2 lights", "4 lights", "8 lights",
                                        "ms per added light", "exponent", "MiB of maps at the most lights"));
  ASSERT_THAT(table.rows, SizeIs(8));
  EXPECT_THAT(table.rows[4], ElementsAre("vsm", "still", "1.5 [1.48, 1.52]", "3 [2.97, 3.03]", "6 [5.94, 6.06]",
                                         "12 [11.9, 12.1]", "1.65 [1.49, 1.81]", "1.00 [0.84, 1.21]", "32"));
  EXPECT_THAT(table.rows[5][1], "moving");
  EXPECT_THAT(table.rows[5][5], HasSubstr("64 ["));
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

TEST(LightSection, ShowsChartTableAndSentences) {
  const TemporaryFolder folder("light_section");
  const auto out = write(folder, make_lit_cells());
  const std::string page = read_text(out / "index.html"), summary = read_text(out / "summary.md");
  for (const char* text : {"with its lights</h3>", "vsm is cheaper than poisson", "Each further light costs",
                           "time of a frame, ms: CPU time (software rasteriser)",
                           "<figure class=\"chart\" id=\"cubes.main.960x540.map1024.lights\">",
                           "lights, each with a map of its own", "dashed, hollow: casters moving", "linear within"})
    EXPECT_THAT(page, HasSubstr(text));
  for (const char* text : {"vsm is cheaper than poisson", "| vsm     | still   | 1.5 \\[1.48, 1.52\\] |"})
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
  EXPECT_THAT(read_text(out / "summary.md"), AllOf(HasSubstr("| poisson | still "), Not(HasSubstr("fronts.csv"))));
}

TEST(LightSection, IsNotThere_WhereNothingWasTimed) {
  const auto cells = make_crossing_cells("cubes");
  const page::Page page{"", {pages::make_trade_section(make_run(), cells, *pages::make_trade(cells))}, {}};
  EXPECT_THAT(page::write_markdown(page), Not(HasSubstr("with its lights")));
}

}  // namespace
}  // namespace shadowbench::analysis
