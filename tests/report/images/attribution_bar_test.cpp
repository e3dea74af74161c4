#include <gmock/gmock.h>

#include "report/images/color_values.h"
#include "report/images/grid.h"
#include "tests/report/records/synthetic.h"

namespace shadowbench::images {

using namespace records;
namespace {

TEST(ErrorParts, Percentages_HaveNoNegativeZero) {
  EXPECT_EQ(records::format_share(-0.001), "0 %");
  EXPECT_EQ(records::format_share(-0.12), "-12 %");
  EXPECT_EQ(records::format_share(0.714), "71 %");
  EXPECT_EQ(records::format_rate(0.0423), "4.23 %");
}

TEST(ErrorParts, ReasonForNoAttribution_IsTheCells) {
  records::CellRecord cell = make_cell("cubes", "mine", 1.0);
  EXPECT_EQ(records::explain_no_attribution(cell), "no truth in this run");
  cell.absent["attribution"] = "no model";
  EXPECT_EQ(records::explain_no_attribution(cell), "no model");
  cell.absent = {};
  EXPECT_EQ(records::explain_no_attribution(cell), "not measured");
}

TEST(AttributionBar, OfASuspectCell_IsNone_SinceItWouldSetTheScale) {
  records::CellRecord cell = make_attributed_cell("mine", 0.04, {0.0, 0.75, -0.25, 0.5});
  cell.status = records::CellStatus::kSuspect;
  EXPECT_FALSE(make_attribution_bar(cell));
  EXPECT_EQ(records::explain_no_attribution(cell), "the filter is suspect");
}

TEST(AttributionBar, Lengths_AreSharesOfTheRmseAndSumToIt) {
  const auto bar = make_attribution_bar(make_attributed_cell("vsm", 0.04, {0.0, 0.75, -0.25, 0.5}));
  ASSERT_TRUE(bar);
  EXPECT_THAT(bar->lengths, ::testing::ElementsAre(0.0, 0.03, -0.01, 0.02));
  EXPECT_DOUBLE_EQ(bar->net(), 0.04);
}

TEST(AttributionBar, WithoutRmseOrAnyShare_ThereIsNone) {
  records::CellRecord cell = make_attributed_cell("vsm", 0.04, {0.0, 0.75, -0.25, 0.5});
  cell.attribution.model.share.reset();
  EXPECT_FALSE(make_attribution_bar(cell));
  cell = make_attributed_cell("vsm", 0.04, {0.0, 0.75, -0.25, 0.5});
  cell.error.rmse.reset();
  EXPECT_FALSE(make_attribution_bar(cell));
}

TEST(AttributionBar, WithoutANumericPart_IsDrawn_AndSaysSo) {
  records::CellRecord cell = make_attributed_cell("mine", 0.04, {0.0, 0.75, -0.25, 0.5});
  cell.attribution.numeric = {};
  EXPECT_DOUBLE_EQ(make_attribution_bar(cell).value().net(), 0.04);
  EXPECT_EQ(records::describe_shares(*records::list_shares(cell)),
            "numeric and estimator 75 %, discretisation -25 %, model 50 %; parts below 0 offset the others");
}

TEST(ErrorParts, SharesBelowZeroOrAboveHundred_AreExplained_OthersAreNot) {
  for (const auto& shares : {records::PartShares{0.0, 1.03, -0.03, 0.0}, {-0.004, -0.004, 1.008, 0.0}})
    EXPECT_THAT(records::describe_shares(shares), ::testing::EndsWith("; parts below 0 offset the others"));
  EXPECT_EQ(records::describe_shares({0.0, 0.0, 1.004, -0.004}),
            "numeric 0 %, estimator 0 %, discretisation 100 %, model 0 %");
}

TEST(AttributionBar, NegativePartsGoLeftOfZero_PositiveOnesRight) {
  const auto segments = stack_segments({{0.25, -0.5, 0.75, -0.125}});
  ASSERT_EQ(segments.size(), 4u);
  EXPECT_DOUBLE_EQ(segments[0].begin, 0.0);
  EXPECT_DOUBLE_EQ(segments[0].end, 0.25);
  EXPECT_DOUBLE_EQ(segments[1].begin, -0.5);
  EXPECT_DOUBLE_EQ(segments[1].end, 0.0);
  EXPECT_DOUBLE_EQ(segments[2].begin, 0.25);
  EXPECT_DOUBLE_EQ(segments[2].end, 1.0);
  EXPECT_DOUBLE_EQ(segments[3].begin, -0.625);
  EXPECT_DOUBLE_EQ(segments[3].end, -0.5);
}

TEST(BarScale, HoldsAllBarsOnARoundLength) {
  const BarScale scale = choose_bar_scale({{{0.0, 0.03, -0.004, 0.01}}, {{0.0, 0.01, 0.0, -0.013}}});
  EXPECT_DOUBLE_EQ(scale.below, 0.013);
  EXPECT_DOUBLE_EQ(scale.length, 0.06);
  EXPECT_DOUBLE_EQ(choose_bar_scale({{}}).length, 0.001);
}

}  // namespace
}  // namespace shadowbench::images
