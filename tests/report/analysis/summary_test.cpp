#include <gmock/gmock.h>

#include "report/analysis/cells.h"
#include "report/analysis/findings.h"
#include "report/records/format.h"
#include "tests/report/records/synthetic.h"

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
}  // namespace shadowbench::analysis
