#include "report/analysis/repeat.h"

#include <gmock/gmock.h>

#include "report/analysis/summary.h"
#include "tests/report/records/synthetic.h"

namespace shadowbench::analysis {

using namespace records;
namespace {

using ::testing::Contains;
using ::testing::Not;
using ::testing::Pair;
using ::testing::SizeIs;

/// A cell whose lookup is `ratio` times that of `none`, known to a tenth of it, and so is its static frame.
records::CellRecord make_timed(const std::string& filter, double ratio) {
  records::CellRecord cell = make_cell("cubes", filter, 4.0);
  cell.ratio_to_none.lookup = cell.ratio_to_none.static_light = records::Ratio{ratio, {0.9 * ratio, 1.1 * ratio}};
  cell.ratio_to_none.moving = records::Ratio{2.0, {1.9, 2.1}};
  return cell;
}

records::CellRecord make_reference() {
  records::CellRecord cell = make_cell("cubes", "none", 4.0);
  cell.ratio_to_none.lookup = cell.ratio_to_none.static_light = cell.ratio_to_none.moving =
      records::Ratio{1.0, {1.0, 1.0}};
  return cell;
}

TEST(Repeat, CountsEveryRatioThatCanDifferOnce) {
  const std::vector<records::CellRecord> a = {make_reference(), make_timed("vsm", 1.0), make_timed("esm", 1.0)};
  const RepeatComparison same = compare_runs(a, a);
  EXPECT_EQ(same.record.cells, 3);
  EXPECT_EQ(same.record.of, 4) << "not the reference's own, and static with the lookup it is";
  EXPECT_EQ(same.record.overlapping, 4);
  EXPECT_THAT(same.apart, SizeIs(0));
  std::vector<records::CellRecord> b = a;
  b[1].ratio_to_none.static_light->median = 1.01;
  EXPECT_EQ(compare_runs(a, b).record.of, 5) << "a static frame of its own";
}

TEST(Repeat, IntervalsThatMeet_Overlap) {
  const std::vector<records::CellRecord> a = {make_timed("vsm", 1.0)};
  std::vector<records::CellRecord> b = a;
  b[0].ratio_to_none.moving->ci95 = {2.1, 2.5};
  EXPECT_EQ(compare_runs(a, b).record.overlapping, 2);
  b[0].ratio_to_none.moving->ci95 = {2.11, 2.5};
  EXPECT_EQ(compare_runs(a, b).record.overlapping, 1);
  EXPECT_EQ(compare_runs(b, a).record.overlapping, 1);
}

TEST(Repeat, WhatIsApart_ComesWithTheWidestGapFirst) {
  const std::vector<records::CellRecord> a = {make_timed("vsm", 1.0), make_timed("esm", 1.0)};
  const std::vector<records::CellRecord> b = {make_timed("esm", 2.0), make_timed("vsm", 1.5)};
  const RepeatComparison found = compare_runs(a, b);
  ASSERT_THAT(found.apart, SizeIs(2));
  EXPECT_EQ(found.apart[0].a, &a[1]);
  EXPECT_EQ(found.apart[0].b, &b[0]);
  EXPECT_EQ(found.apart[0].ratio, "lookup");
  EXPECT_NEAR(found.apart[0].gap, 1.8 / 1.1 - 1.0, 1e-12);
  EXPECT_NEAR(found.apart[1].gap, 1.35 / 1.1 - 1.0, 1e-12);
}

/// The groups of phases move together: by 0.0005 between the runs, and by 0.01 among each other.
TEST(Repeat, ErrorsThatDiffer_AreToldApartByTheirGroupsOfPhases) {
  records::CellRecord one = make_attributed_cell("vsm", 0.1, {0.0, 0.1, 0.1, 0.8}), other = one;
  one.rmse_replicates = {0.09, 0.1, 0.1, 0.11};
  one.rmse_ci95 = other.rmse_ci95 = records::Interval{0.08, 0.12};
  other.rmse_replicates = {0.0905, 0.10051, 0.10049, 0.1105};
  other.error.rmse = 0.1005;
  const RepeatComparison found = compare_runs({one}, {other});
  EXPECT_EQ(found.errors, 1);
  ASSERT_THAT(found.errors_apart, SizeIs(1));
  EXPECT_NEAR(found.errors_apart[0].gap.value, 0.0005, 1e-12);
  EXPECT_THAT(compare_runs({one}, {one}).errors_apart, SizeIs(0));
  other.rmse_replicates = {0.0995, 0.0905, 0.1115, 0.1005};
  EXPECT_THAT(compare_runs({one}, {other}).errors_apart, SizeIs(0)) << "groups that move apart tell nothing";
  other.error.rmse = 0.10005;
  other.rmse_replicates = {0.09005, 0.10005, 0.10005, 0.11005};
  EXPECT_THAT(compare_runs({one}, {other}).errors_apart, SizeIs(0)) << "too small to matter";
}

TEST(Repeat, CellsAndRatiosThatOneRunLacks_AreLeftOut) {
  const std::vector<records::CellRecord> a = {make_timed("vsm", 1.0), make_timed("esm", 1.0)};
  std::vector<records::CellRecord> b = {make_timed("esm", 1.0), make_timed("poisson", 1.0)};
  b[0].ratio_to_none.moving.reset();
  const records::RepeatRecord record = compare_runs(a, b).record;
  EXPECT_EQ(record.cells, 1);
  EXPECT_EQ(record.of, 1);
}

TEST(Repeat, IsAFactOfTheRun_WhereItIsKnown) {
  records::RunRecord run = make_run();
  EXPECT_THAT(list_run_facts(run), Not(Contains(Pair("repeat", ::testing::_))));
  run.repeat = {40, 118, 120};
  EXPECT_THAT(list_run_facts(run),
              Contains(Pair("repeat",
                            "118 of 120 ratio intervals overlap those of the run that this one replaced (40 cells)")));
}

}  // namespace
}  // namespace shadowbench::analysis
