#include "report/analysis/measures.h"

#include <gmock/gmock.h>

#include <cmath>

#include "reference/metrics/error_stats.h"

namespace shadowbench::analysis {
namespace {

using ::testing::ElementsAre;

FrontPoint make_point(double error, double cost, double error_se = 0.0, double cost_half = 0.0) {
  return {{error, error - error_se, error + error_se}, {cost, cost - cost_half, cost + cost_half}};
}

std::vector<Standing> list_standings(const std::vector<FrontPoint>& points) {
  std::vector<Standing> standings;
  for (const Placement& each : find_front(points)) standings.push_back(each.standing);
  return standings;
}

TEST(Front, OfNothing_IsEmpty) { EXPECT_TRUE(find_front({}).empty()); }

TEST(Front, HoldsWhatNothingBeats_CheapestFirst) {
  const std::vector<FrontPoint> points = {make_point(0.1, 3.0), make_point(0.3, 1.0), make_point(0.2, 2.0),
                                          make_point(0.25, 2.5)};
  const auto placements = find_front(points);
  EXPECT_THAT(list_members(points, placements), ElementsAre(1, 2, 0));
  EXPECT_EQ(placements[3].standing, Standing::kDominated);
  EXPECT_EQ(placements[3].by, 2u);
}

TEST(Front, ADominatedCell_NamesTheCheapestThatBeatsIt) {
  const auto placements = find_front({make_point(0.2, 1.0), make_point(0.1, 2.0), make_point(0.3, 4.0)});
  EXPECT_EQ(placements[2].by, 0u);
}

TEST(Front, EqualCostOrEqualError_IsBeatenByTheBetterOther) {
  EXPECT_THAT(list_standings({make_point(0.2, 1.0), make_point(0.1, 1.0)}),
              ElementsAre(Standing::kDominated, Standing::kFront));
  EXPECT_THAT(list_standings({make_point(0.2, 1.0), make_point(0.2, 2.0)}),
              ElementsAre(Standing::kFront, Standing::kDominated));
}

TEST(Front, CellsThatAreAlike_AreTied) {
  EXPECT_THAT(list_standings({make_point(0.2, 1.0), make_point(0.2, 1.0)}),
              ElementsAre(Standing::kFront, Standing::kTied));
}

TEST(Front, OverlappingCostAndErrorWithinTheTruth_AreTied) {
  const auto placements = find_front({make_point(0.200, 1.0, 0.001, 0.2), make_point(0.2005, 1.3, 0.001, 0.2)});
  EXPECT_EQ(placements[1].standing, Standing::kTied);
  EXPECT_EQ(placements[1].by, 0u);
}

TEST(Front, ErrorsDiffer_BeyondTheLargerStandardError_NotTheSumOfBoth) {
  EXPECT_FALSE(is_clearly_less_error({0.2, 0.199, 0.201}, {0.201, 0.2, 0.202}));
  EXPECT_TRUE(is_clearly_less_error({0.2, 0.199, 0.201}, {0.2015, 0.2005, 0.2025}));
}

/// Both move by 0.01 from group to group, and their difference by a hundredth of that.
TEST(Front, ErrorsOfTheSamePhases_DifferByWhatTheirDifferencesSay) {
  const Estimate a{0.2, 0.18, 0.22, {0.19, 0.2, 0.2, 0.21}}, b{0.201, 0.18, 0.222, {0.1911, 0.2009, 0.201, 0.211}};
  EXPECT_TRUE(is_clearly_less_error(a, b));
  EXPECT_FALSE(is_clearly_less_error(b, a));
  EXPECT_FALSE(is_clearly_less_error(a, a));
  const Estimate gap = subtract(b, a);
  EXPECT_NEAR(gap.value, 0.001, 1e-12);
  EXPECT_NEAR(gap.high - gap.value, metrics::find_student_t(4) * std::sqrt(2e-8 / 3.0 / 4.0), 1e-9);
  Estimate other = b;
  other.replicates.pop_back();
  EXPECT_FALSE(is_clearly_less_error(a, other)) << "of other phases, and then within both intervals";
}

TEST(Front, AGainWithinTheTruthsError_IsNotWorthItsCost) {
  EXPECT_THAT(list_standings({make_point(0.2, 1.0, 0.001), make_point(0.1995, 3.0, 0.001)}),
              ElementsAre(Standing::kFront, Standing::kDominated));
}

TEST(Front, AnUncertainTime_BeatsNothingByBeingUncertain) {
  EXPECT_FALSE(dominates(make_point(0.1, 3.0, 0.0, 2.5), make_point(0.2, 1.0)));
  const auto standings = list_standings({make_point(0.2, 1.0), make_point(0.1, 3.0, 0.0, 2.5)});
  EXPECT_THAT(standings, ElementsAre(Standing::kFront, Standing::kFront));
}

TEST(Front, ChainsOfTies_DoNotJoinWhatIsFarApart) {
  const auto placements =
      find_front({make_point(0.2, 1.0, 0.0, 0.15), make_point(0.2, 1.25, 0.0, 0.15), make_point(0.2, 1.5, 0.0, 0.15)});
  EXPECT_EQ(placements[1].standing, Standing::kTied);
  EXPECT_EQ(placements[2].standing, Standing::kDominated);
  EXPECT_EQ(placements[2].by, 0u);
}

TEST(Front, WhoIsTiedWithATiedCellOnly_IsOnTheFront) {
  const auto placements = find_front(
      {make_point(0.200, 1.0, 0.01, 0.15), make_point(0.193, 1.25, 0.01, 0.15), make_point(0.186, 1.4, 0.01, 0.15)});
  EXPECT_EQ(placements[1].standing, Standing::kTied);
  EXPECT_EQ(placements[2].standing, Standing::kFront);
}

TEST(Front, GroupsHaveFrontsOfTheirOwn_AndWhatHasNoneIsApart) {
  std::vector<FrontPoint> points = {make_point(0.3, 1.0), make_point(0.2, 0.5), make_point(0.4, 2.0),
                                    make_point(0.1, 0.1), make_point(0.1, 0.1)};
  points[1].group = 1;
  points[3].group = points[4].group = std::nullopt;
  const auto placements = find_front(points);
  EXPECT_THAT(list_standings(points), ElementsAre(Standing::kFront, Standing::kFront, Standing::kDominated,
                                                  Standing::kApart, Standing::kApart));
  EXPECT_EQ(placements[2].by, 0u) << "what is cheaper and better is of another group";
  EXPECT_THAT(list_members(points, placements), ElementsAre(0, 1)) << "group by group";
}

TEST(Front, EveryCellOffTheFront_NamesAMember) {
  std::vector<FrontPoint> points;
  for (int i = 0; i < 60; ++i) {
    const double error = 0.1 + 0.01 * ((i * 37) % 60), cost = 1.0 + 0.1 * ((i * 23) % 60);
    points.push_back(make_point(error, cost, 0.005, 0.1 * (i % 7)));
  }
  const auto placements = find_front(points);
  for (std::size_t i = 0; i < points.size(); ++i) {
    EXPECT_EQ(placements[placements[i].by].standing, Standing::kFront);
    if (placements[i].standing == Standing::kDominated) EXPECT_TRUE(dominates(points[placements[i].by], points[i]));
    if (placements[i].standing == Standing::kTied) EXPECT_TRUE(is_tied(points[placements[i].by], points[i]));
  }
}

}  // namespace

}  // namespace shadowbench::analysis
