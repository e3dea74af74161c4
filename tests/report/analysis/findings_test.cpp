#include "report/analysis/findings.h"

#include <gmock/gmock.h>

#include "report/analysis/cells.h"
#include "report/analysis/trade.h"
#include "report/records/format.h"
#include "tests/report/records/synthetic.h"
#include "trade_cells.h"

namespace shadowbench::analysis {
using namespace records;
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::SizeIs;

TEST(Summary, Numbers_HaveThreeDigits) {
  EXPECT_EQ(records::format_number(0.05124), "0.0512");
  EXPECT_EQ(records::format_number(4.0), "4");
  EXPECT_EQ(records::format_number(13.94), "13.9");
  EXPECT_EQ(records::format_number(99.96), "100");
  EXPECT_EQ(records::format_number(1240.4), "1240");
  EXPECT_EQ(records::format_number(4194304.0), "4194304");
}

TEST(Summary, SoftwareTimes_AreCalledCpuTime) {
  records::GlRecord gl = make_run().gl;
  EXPECT_EQ(records::describe_clock(gl), "CPU time (software rasteriser)");
  EXPECT_EQ(records::time_unit(gl), "ms (CPU)");
  gl.software = false;
  gl.timer = records::TimerKind::kTimerQuery;
  EXPECT_EQ(records::describe_clock(gl), "GPU time (timer query)");
  EXPECT_EQ(records::time_unit(gl), "ms (GPU)");
}

TEST(Summary, Groups_HoldOnlyWhatMayBeCompared) {
  std::vector<records::CellRecord> cells = {make_cell("cubes", "none", 4.0), make_cell("stack", "none", 4.0),
                                            make_cell("cubes", "vsm", 4.0), make_cell("cubes", "vsm", 4.0)};
  cells[3].map_size = 2048;
  const auto groups = group_cells(cells);
  ASSERT_THAT(groups, SizeIs(3));
  EXPECT_THAT(groups[0].cells, SizeIs(2));
  EXPECT_EQ(groups[1].scene, "stack");
  EXPECT_EQ(groups[2].cells[0].map_size, 2048);
}

TEST(Summary, OnlyAWrongRange_IsNamedInTheSettings) {
  records::CellRecord cell = make_cell("cubes", "none", 4.0);
  EXPECT_THAT(records::describe_settings(cell), Not(AnyOf(HasSubstr("outside"), HasSubstr("test off"))));
  cell.range = {"repeat", false, false};
  EXPECT_THAT(records::describe_settings(cell),
              AllOf(HasSubstr("outside the map: repeat"), HasSubstr("far-plane test off"),
                    HasSubstr("behind-the-light test off")));
}

TEST(Summary, Absences_AreCounted) {
  const auto counts = count_absences({make_cell("cubes", "a", 1.0), make_cell("cubes", "b", 1.0)});
  EXPECT_EQ(counts.at("error: no truth in this run"), 2);
}

TEST(Summary, ExperimentLine_SaysItsTitleAndWhichShardItIs) {
  records::RunRecord run = make_run();
  run.experiment = {"A sweep", "", 30, 1, 1};
  EXPECT_THAT(list_run_facts(run), Contains(::testing::Pair("experiment", "A sweep · 30 cells")));
  run.experiment = {"", "", 30, 2, 3};
  EXPECT_THAT(list_run_facts(run), Contains(::testing::Pair("experiment", "30 cells, shard 2 of 3")));
}

TEST(Summary, WorkLine_CountsTruthsTracedAndReadFromTheCache) {
  EXPECT_THAT(
      list_run_facts(make_run()),
      Contains(::testing::Pair("work",
                               "12 shader variants compiled, 40 passes run, 3 passes skipped because no "
                               "filter needed them, 5 truths ray traced, 2 truths read from the cache; 1.5 s of timed "
                               "passes in 2 s, of which attribution took 0.5 s")));
}

}  // namespace

namespace {

using ::testing::SizeIs;

records::CellRecord make_light_cell(const SweepCell& from, double asked) {
  records::CellRecord cell = make_sweep_cell(from);
  cell.kernel.width_class = "light";
  cell.kernel.light_texels = asked;
  if (from.filter != "none") cell.kernel.by_light = "radius";
  cell.key = records::cell_key(cell);
  return cell;
}

/// On `ball` the filter is as wide as it should be, on `cubes` as narrow as it can.
std::vector<records::CellRecord> make_cells() {
  return {make_light_cell({.scene = "ball", .rmse = 0.1}, 4.0),
          make_light_cell({.scene = "ball", .filter = "vsm", .radius = 4.0, .rmse = 0.05}, 4.0),
          make_light_cell({.scene = "cubes", .rmse = 0.1}, 0.2),
          make_light_cell({.scene = "cubes", .filter = "vsm", .radius = 0.4, .rmse = 0.2}, 0.2)};
}

TEST(LightWidths, OneFilter_IsOneConfigurationOnAllScenes) {
  const auto cells = make_cells();
  const auto configurations = list_configurations(point_to(cells));
  ASSERT_THAT(configurations, SizeIs(2));
  EXPECT_EQ(configurations[1].name, "vsm");
  EXPECT_EQ(describe_kernel(configurations[1]), "0.4 .. 4 texels (light)");
  const auto scopes = make_trade_scopes(cells);
  ASSERT_THAT(scopes, SizeIs(3));
  EXPECT_THAT(scopes[0].configurations, SizeIs(2));
  const auto points = list_points(scopes[0], list_error_measures()[0], list_cost_measures(cells)[kMovingCost]);
  ASSERT_THAT(points, SizeIs(2));
  EXPECT_EQ(name_class(points[0].group), "light") << "none is compared with them";
}

}  // namespace

using namespace records;
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

records::CellRecord make_stable_cell() {
  records::CellRecord cell = make_cell("cubes", "odd", 4.0);
  cell.params = {{"k", 20.0}, {"store", std::string("r16f")}};
  cell.map_size = 100;
  cell.stability = {0, 0, 0, 1e-7, 2.5, 11.08, 0.001, 0.0001, 0.0, 0, 0};
  return cell;
}

TEST(StabilityWords, NothingBreaks_NothingIsSaid) {
  EXPECT_THAT(describe_stability({"cubes", {make_stable_cell(), make_cell("cubes", "none", 1.0)}}), IsEmpty());
  EXPECT_EQ(caption_texels(make_cell("cubes", "none", 1.0)), "");
  EXPECT_EQ(caption_bound(make_stable_cell()), "kept at every receiver");
  EXPECT_THAT(caption_texels(make_stable_cell()),
              AllOf(HasSubstr("r16f holds numbers up to 65504 (e^11.09)"), HasSubstr("2.5 left"),
                    HasSubstr("safe up to an exponent of 11.08")));
}

TEST(StabilityWords, Overflow_NamesLimitAndSafeValue) {
  records::CellRecord cell = make_stable_cell();
  cell.stability.overflow_texels = 290;
  cell.stability.nan_texels = 10;
  cell.stability.headroom.reset();
  const auto sentences = describe_stability({"cubes", {cell}});
  ASSERT_EQ(sentences.size(), 1u);
  EXPECT_EQ(sentences[0],
            "odd: 3 % of its map's texels overflowed: r16f holds numbers up to 65504 (e^11.09); an "
            "exponent "
            "of 11.08 is safe here.");
}

TEST(StabilityWords, EveryTrouble_HasItsSentence) {
  records::CellRecord cell = make_stable_cell();
  cell.stability.negative_variance_texels = 5000;
  cell.stability.lowest_variance = -7.2e-4;
  cell.stability.half_difference_max = 0.25;
  cell.stability.half_difference_rms = 0.0125;
  cell.stability.bound_shortfall_max = 0.125;
  cell.stability.bound_violations = 7;
  cell.stability.bound_exact_violations = 8;
  const auto sentences = describe_stability({"cubes", {cell}});
  ASSERT_EQ(sentences.size(), 3u);
  EXPECT_THAT(sentences[0],
              HasSubstr("the variance of 50 % of its map's texels is below 0 before the clamp, down to -0.00072"));
  EXPECT_THAT(sentences[1], HasSubstr("visibility is up to 0.25 off that of the 32-bit store (RMS 0.0125)"));
  EXPECT_THAT(sentences[2], AllOf(HasSubstr("by up to 0.125; at 7 receivers by more than rounding explains"),
                                  HasSubstr("at 8 in exact arithmetic")));
}

}  // namespace

}  // namespace shadowbench::analysis
