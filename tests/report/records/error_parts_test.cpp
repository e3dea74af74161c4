#include <gmock/gmock.h>

#include "tests/report/records/synthetic.h"

namespace shadowbench::records {

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

TEST(ErrorParts, OfASuspectCell_AreNone) {
  records::CellRecord cell = make_attributed_cell("mine", 0.04, {0.0, 0.75, -0.25, 0.5});
  cell.status = records::CellStatus::kSuspect;
  EXPECT_EQ(records::explain_no_attribution(cell), "the filter is suspect");
}

TEST(ErrorParts, WithoutANumericPart_SaySo) {
  records::CellRecord cell = make_attributed_cell("mine", 0.04, {0.0, 0.75, -0.25, 0.5});
  cell.attribution.numeric = {};
  EXPECT_EQ(records::describe_shares(*records::list_shares(cell)),
            "numeric and estimator 75 %, discretisation -25 %, model 50 %; parts below 0 offset the others");
}

TEST(ErrorParts, SharesBelowZeroOrAboveHundred_AreExplained_OthersAreNot) {
  for (const auto& shares : {records::PartShares{0.0, 1.03, -0.03, 0.0}, {-0.004, -0.004, 1.008, 0.0}})
    EXPECT_THAT(records::describe_shares(shares), ::testing::EndsWith("; parts below 0 offset the others"));
  EXPECT_EQ(records::describe_shares({0.0, 0.0, 1.004, -0.004}),
            "numeric 0 %, estimator 0 %, discretisation 100 %, model 0 %");
}

}  // namespace
}  // namespace shadowbench::records
