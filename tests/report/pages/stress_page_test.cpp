#include "report/pages/stress_page.h"

#include <nlohmann/json.hpp>

#include "report/records/stress_record.h"
#include "tests/report/pages/answer.h"
#include "tests/test_files.h"

namespace shadowbench::pages {
namespace {

records::StressCase make_case() {
  records::StressCase item;
  item.filter = "esm";
  item.variant = "r16f, linear";
  item.level = "GL";
  item.params = {{"radius", 4.0}, {"store", std::string("r16f")}};
  item.samples = {{1.0, records::StressVerdict::kOk, 1e-4, ""},
                  {11.0, records::StressVerdict::kDegraded, 0.05, "error 0.05"},
                  {20.0, records::StressVerdict::kBroken, std::nullopt, "7 texels overflowed"}};
  item.degraded = records::StressOnset{11.0, 1.0, "error 0.05"};
  item.broken = records::StressOnset{20.0, 11.0, "7 texels overflowed"};
  item.limits = {
      {{11.09, records::StressTheoryKind::kOverflow, "ln(65504)", "derived", records::StressVerdict::kBroken},
       20.0,
       1.803,
       records::StressAgreement::kDisagrees,
       ""},
      {{std::nullopt, records::StressTheoryKind::kRounding, "none", "derived", records::StressVerdict::kDegraded},
       11.0,
       std::nullopt,
       records::StressAgreement::kExplained,
       "the blur adds"}};
  item.notes = {"broken at 20, but ok again at 30"};
  return item;
}

records::StressRecord make_record() {
  records::StressRecord record;
  record.commit = "abc";
  record.gl = {"osmesa", "llvmpipe", "4.5", true, records::TimerKind::kWallClock};
  record.machine.cpu = "a cpu";
  record.filters = {"esm"};
  records::StressAxis axis;
  axis.id = "esm-exponent";
  axis.title = "Exponent";
  axis.quantity = "exponent c";
  axis.unit = "1/depth";
  axis.log = true;
  axis.range = {1.0, 100.0};
  axis.measured = "error";
  axis.bound = 0.02;
  axis.broken_when = "infinite";
  axis.cases.push_back(make_case());
  records::StressCase absent;
  absent.variant = "r8";
  absent.level = "GL";
  absent.not_available = "this GL lacks r8";
  axis.cases.push_back(absent);
  record.axes.push_back(axis);
  return record;
}

TEST(StressJson, HoldsEverything_AbsentIsNull) {
  const nlohmann::json json = nlohmann::json::parse(records::make_stress_json(make_record()));
  EXPECT_EQ(json["schema_version"], records::kStressSchemaVersion);
  EXPECT_EQ(json["gl"]["backend"], "osmesa");
  EXPECT_EQ(json["machine"]["cpu"], "a cpu");
  EXPECT_EQ(json["disagreements"], 1);
  const nlohmann::json& axis = json["axes"][0];
  EXPECT_EQ(axis["range"], nlohmann::json::parse("[1.0, 100.0]"));
  const nlohmann::json& item = axis["cases"][0];
  EXPECT_EQ(item["params"]["store"], "r16f");
  EXPECT_EQ(item["samples"][1]["verdict"], "degraded");
  EXPECT_TRUE(item["samples"][2]["measured"].is_null());
  EXPECT_EQ(item["broken"]["last_before"], 11.0);
  EXPECT_EQ(item["limits"][0]["agreement"], "disagrees");
  EXPECT_EQ(item["limits"][0]["tolerance"], 1.1);
  EXPECT_TRUE(item["limits"][1]["theory"].is_null());
  EXPECT_EQ(item["limits"][1]["explanation"], "the blur adds");
  EXPECT_EQ(axis["cases"][1]["not_available"], "this GL lacks r8");
  EXPECT_TRUE(axis["cases"][1]["broken"].is_null());
}

TEST(StressCsv, HasARowPerObservation_AndOneForWhatIsAbsent) {
  const std::string csv = records::make_stress_csv(make_record());
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 1 + 3 + 1);
  EXPECT_THAT(csv, HasSubstr("esm-exponent,esm,\"r16f, linear\",GL,20,broken,,7 texels overflowed\r\n"));
  EXPECT_THAT(csv, HasSubstr("esm-exponent,,r8,GL,,not available,,this GL lacks r8\r\n"));
}

TEST(StressTables, SayWhatIsSafe_AndWhatIsNotAvailable) {
  const records::TextTable table = make_case_table(make_record().axes[0]);
  ASSERT_THAT(table.rows, SizeIs(2));
  EXPECT_THAT(table.rows[0], ElementsAre("esm: r16f, linear (GL)", "1", "11", "20", "7 texels overflowed", "3"));
  EXPECT_EQ(table.rows[1][4], "not available: this GL lacks r8");
}

TEST(StressTables, CaseThatNeverChanges_IsOkAllOver) {
  records::StressAxis axis = make_record().axes[0];
  axis.cases[0].degraded.reset();
  axis.cases[0].broken.reset();
  EXPECT_EQ(make_case_table(axis).rows[0][1], "all of the range");
}

TEST(StressTables, LimitsStandBesideTheirTheory) {
  const records::TextTable table = make_limit_table(make_record());
  ASSERT_THAT(table.rows, SizeIs(2));
  EXPECT_THAT(table.rows[0], ElementsAre("esm-exponent", "esm: r16f, linear (GL)", "broken", "ln(65504)", "11.09", "20",
                                         "1.803", "overflow, 10 %", "disagrees"));
  EXPECT_EQ(table.rows[1][4], "none");
}

TEST(StressTables, LimitsThatNobodyExpectsToSee_AreLeftOut) {
  records::StressRecord record = make_record();
  std::vector<records::StressLimit>& limits = record.axes[0].cases[0].limits;
  limits[0].measured.reset();  // it should have been met
  limits[1].measured.reset();
  limits[1].agreement = records::StressAgreement::kAgrees;
  limits.push_back(limits[1]);
  limits.back().onset = 1e6;
  EXPECT_THAT(make_limit_table(record).rows, SizeIs(1));
}

TEST(StressPage, DisagreementsAreSaid_ExplainedOnesWithTheReason) {
  const records::StressRecord record = make_record();
  EXPECT_EQ(records::count_disagreements(record), 1);
  EXPECT_THAT(describe_stress_limits(record.axes[0], records::StressAgreement::kDisagrees),
              ElementsAre(AllOf(HasSubstr("broken at 20, where theory says 11.09 (ln(65504))"),
                                HasSubstr("nothing explains it"))));
  EXPECT_THAT(describe_stress_limits(record.axes[0], records::StressAgreement::kExplained),
              ElementsAre(AllOf(HasSubstr("degraded at 11, where theory says none"), HasSubstr("the blur adds"))));
}

TEST(StressPage, BeginsWithTheAnswer_WhoHoldsFurthest_AndWhatFails) {
  records::StressRecord record = make_record();
  records::StressCase other = record.axes[0].cases[0];
  other.filter = "vsm";
  other.degraded.reset();
  other.broken.reset();
  record.axes[0].cases.push_back(other);
  const document::Page page = make_stress_page(record);
  EXPECT_EQ(document::answer_of(page),
            "esm: r16f, linear (GL) breaks at exponent c = 20; theory 11.09. Limits that disagree with theory: 2.");
  EXPECT_EQ(document::verdict_of(page, "esm-exponent: exponent c, 1 .. 100", "esm"),
            std::pair(std::string("\u2717 0 %"), document::Grade::kBad));
  EXPECT_EQ(document::verdict_of(page, "esm-exponent", "vsm"), std::pair(std::string("100 %"), document::Grade::kGood));
}

TEST(StressPage, Verdict_IsTheWorstVariants_FromTheEasyEndOn) {
  records::StressRecord record = make_record();
  std::vector<records::StressCase>& cases = record.axes[0].cases;
  cases.push_back(cases[0]);
  cases[0].broken.reset();
  cases[0].degraded = records::StressOnset{9.9, 10.0, ""};  // the range is hard at its low end
  cases[2].broken.reset();
  cases[2].degraded = records::StressOnset{1.1, std::pow(10.0, 0.5), ""};
  const auto verdict = [&] { return document::verdict_of(make_stress_page(record), "esm-exponent", "esm"); };
  EXPECT_EQ(verdict(), std::pair(std::string("50 .. 75 %"), document::Grade::kNear));
  cases[0].degraded->last_before = 11.0;
  EXPECT_EQ(verdict(), std::pair(std::string("\u2717 48 .. 75 %"), document::Grade::kBad));
  cases[0].degraded->last_before.reset();
  EXPECT_EQ(verdict().first, "\u2717 0 .. 75 %");
  cases[0].level = "model";  // says what the GL should do
  EXPECT_EQ(verdict(), std::pair(std::string("75 %"), document::Grade::kNear));
}

TEST(StressChart, HasCasesTheoryAndBound_BrokenAtTheTopWhereNothingIsMeasured) {
  const document::Chart chart = make_stress_chart(make_record().axes[0]).value();
  EXPECT_EQ(chart.id, "stress.esm-exponent");
  EXPECT_TRUE(chart.x.log && chart.y.log);
  ASSERT_THAT(chart.series, SizeIs(4));
  EXPECT_EQ(chart.series[0].title, "esm: r16f, linear (GL)");
  EXPECT_THAT(chart.series[0].points, SizeIs(2));  // the third measured nothing
  EXPECT_FALSE(chart.series[0].filled);
  ASSERT_THAT(chart.series[1].points, SizeIs(1));
  EXPECT_TRUE(chart.series[1].filled);
  EXPECT_EQ(chart.series[1].points[0].x.value, 20.0);
  EXPECT_EQ(chart.series[1].points[0].y.value, chart.y.high);
  EXPECT_THAT(chart.series[1].points[0].details, Contains("7 texels overflowed"));
  EXPECT_EQ(chart.series[2].title, "bound, 0.02");
  EXPECT_EQ(chart.series[3].title, "theoretical limits");
  for (const document::ChartPoint& point : chart.series[3].points) EXPECT_EQ(point.x.value, 11.09);
  EXPECT_THAT(chart.notes, Contains("some cases have no theoretical limit"));
}

TEST(StressChart, LevelsOfAVariant_ShareTheirColour_TheModelIsDashed) {
  records::StressAxis axis = make_record().axes[0];
  axis.cases[1] = axis.cases[0];
  axis.cases[1].level = "model";
  const document::Chart chart = make_stress_chart(axis).value();
  const auto model = std::ranges::find(chart.series, "esm: r16f, linear (model)", &document::ChartSeries::title);
  ASSERT_NE(model, chart.series.end());
  EXPECT_EQ(model->color, chart.series[0].color);
  EXPECT_EQ(model->line, document::LineStyle::kDashed);
  EXPECT_EQ(model->mark, document::Mark::kNone);
}

TEST(StressChart, AtMostSixCases_AreShown_TheWorstAndNone) {
  records::StressAxis axis = make_record().axes[0];
  const records::StressCase item = axis.cases[0];
  axis.cases.clear();
  for (int i = 0; i < 9; ++i) {
    axis.cases.push_back(item);
    axis.cases.back().filter = i == 0 ? "none" : fmt::format("f{}", i);
    axis.cases.back().degraded = records::StressOnset{99.0, 90.0 - i, ""};
    axis.cases.push_back(axis.cases.back());
    axis.cases.back().level = "model";
  }
  EXPECT_THAT(
      document::list_shown(make_stress_chart(axis).value()),
      ElementsAre("none: r16f, linear (GL)", "f4: r16f, linear (GL)", "f5: r16f, linear (GL)", "f6: r16f, linear (GL)",
                  "f7: r16f, linear (GL)", "f8: r16f, linear (GL)", "bound, 0.02", "theoretical limits"));
}

TEST(StressChart, CaseWithNothingMeasured_IsNotDrawn) {
  records::StressAxis axis = make_record().axes[0];
  axis.cases.erase(axis.cases.begin());
  EXPECT_FALSE(make_stress_chart(axis));
}

}  // namespace
}  // namespace shadowbench::pages
