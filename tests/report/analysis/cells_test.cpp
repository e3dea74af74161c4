#include "report/analysis/cells.h"

#include <gmock/gmock.h>

#include "tests/report/records/synthetic.h"

namespace shadowbench::analysis {
using namespace records;
namespace {

TEST(FindDominatingPart, IsTheOnlyOneAboveHalf) {
  EXPECT_EQ(find_dominating_part({0.0, 0.51, 0.0, 0.49}), 1u);
  EXPECT_EQ(find_dominating_part({0.0, 0.5, 0.5, 0.0}), std::nullopt);
  EXPECT_EQ(find_dominating_part({0.0, 0.9, 0.8, -0.7}), std::nullopt);
  EXPECT_EQ(find_dominating_part({-0.3, -0.3, 0.2, 1.4}), 3u);
}

TEST(RmseReach, IsHalfTheIntervalOrTheTruthsStandardError) {
  records::CellRecord cell = make_attributed_cell("vsm", 0.04, {0.0, 0.7, 0.1, 0.2});
  EXPECT_EQ(find_rmse_reach(cell), *cell.truth.se);
  cell.rmse_ci95 = records::Interval{0.03, 0.05};
  EXPECT_DOUBLE_EQ(find_rmse_reach(cell), 0.01);
}

TEST(LostInTruth, IsAnErrorThatTheTruthsOwnExplains) {
  EXPECT_TRUE(is_lost_in_truth(make_attributed_cell("vsm", 0.001, {0.0, 0.7, 0.1, 0.2})));
  EXPECT_FALSE(is_lost_in_truth(make_attributed_cell("vsm", 0.04, {0.0, 0.7, 0.1, 0.2})));
  EXPECT_FALSE(is_lost_in_truth(make_cell("cubes", "vsm", 4.0)));
}

}  // namespace

}  // namespace shadowbench::analysis
