#include "report/analysis/summary.h"

#include <gmock/gmock.h>

#include <algorithm>

#include "report/analysis/cell_group.h"
#include "report/analysis/ranking.h"
#include "report/records/format.h"
#include "tests/report/records/synthetic.h"

namespace shadowbench::analysis {

using namespace records;
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::SizeIs;

records::CellRecord make_ranked(const std::string& filter, double low, double median, double high) {
  records::CellRecord cell = make_cell("cubes", filter, median);
  cell.time_ms.moving = records::OwnTime{{median, low, high, 9}, {low, high}};
  return cell;
}

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

TEST(Summary, Ranking_GoesByCostAndTiesOverlappingIntervals) {
  const std::vector<records::CellRecord> cells = {
      make_ranked("slow", 3.0, 3.1, 3.2), make_ranked("none", 1.0, 1.0, 1.0), make_ranked("near", 0.98, 1.01, 1.04),
      make_ranked("apart", 1.05, 1.1, 1.15)};
  EXPECT_THAT(rank_costs(cells), ElementsAre(ElementsAre(1, 2), ElementsAre(3), ElementsAre(0)));
}

TEST(Summary, Ties_AreWithTheFastestOfAGroup) {
  const std::vector<records::CellRecord> chain = {make_ranked("a", 1.0, 1.1, 1.2), make_ranked("b", 1.15, 1.25, 1.35),
                                                  make_ranked("c", 1.3, 1.4, 1.5)};
  EXPECT_THAT(rank_costs(chain), ElementsAre(ElementsAre(0, 1), ElementsAre(2)));
}

TEST(Summary, WithoutIntervals_QuartilesRankAndUntimedCellsAreLeftOut) {
  std::vector<records::CellRecord> cells = {make_cell("cubes", "a", 9.0), make_cell("cubes", "b", 4.0),
                                            make_cell("cubes", "c", 4.1), make_cell("cubes", "d", 1.0)};
  cells[3].time_ms.lookup.reset();
  EXPECT_THAT(rank_costs(cells), ElementsAre(ElementsAre(1, 2), ElementsAre(0)));
}

TEST(Summary, OverlappingFilters_AreCalledTied) {
  const CellGroup group{
      "cubes",
      {make_ranked("none", 1.0, 1.0, 1.0), make_ranked("pcf2x2", 0.98, 1.01, 1.04), make_ranked("vsm", 2.0, 2.1, 2.2)}};
  const auto sentences = describe_group(group, make_run().gl);
  EXPECT_THAT(sentences, Contains("With a moving light, cheapest first: none tied with pcf2x2; then vsm."));
  EXPECT_THAT(sentences, Contains(HasSubstr("CPU time (software rasteriser)")));
}

TEST(Summary, FailedCellsAndPixelsThatAreNotFinite_AreSaid) {
  CellGroup group{"cubes", {make_cell("cubes", "vsm", 4.0), make_cell("cubes", "mine", 4.0)}};
  group.cells[0].nan = 12;
  group.cells[1].status = records::CellStatus::kTimeout;
  group.cells[1].message = "no answer after 10 s";
  group.cells[1].time_ms = {};
  const auto sentences = describe_group(group, make_run().gl);
  EXPECT_THAT(sentences, Contains("vsm has 12 pixels that are not finite."));
  EXPECT_THAT(sentences, Contains("mine did not finish (timeout: no answer after 10 s)."));
}

TEST(Summary, SuspectCells_AreNamed_AndRankedNowhere) {
  CellGroup group{"cubes", {make_ranked("vsm", 1.0, 1.0, 1.0), make_ranked("mine", 0.1, 0.1, 0.1)}};
  group.cells[1].status = records::CellStatus::kSuspect;
  group.cells[1].message = "it reads nothing";
  const auto sentences = describe_group(group, make_run().gl);
  const auto named = std::ranges::count_if(
      sentences, [](const std::string& sentence) { return sentence.find("mine") != std::string::npos; });
  EXPECT_EQ(named, 1);
  EXPECT_THAT(sentences, Contains("mine is left out of rankings, fronts, advice and common scales, for it is suspect: "
                                  "it reads nothing."));
}

TEST(Summary, OneFilterTwice_IsToldApartByItsParameters) {
  CellGroup group{"cubes", {make_ranked("vsm", 1.0, 1.0, 1.0), make_ranked("vsm", 2.0, 2.0, 2.0)}};
  group.cells[1].params["radius"] = 8.0;
  EXPECT_THAT(describe_group(group, make_run().gl)[0],
              HasSubstr("vsm (radius 4, store rg32f); then vsm (radius 8, store rg32f)"));
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
}  // namespace shadowbench::analysis
