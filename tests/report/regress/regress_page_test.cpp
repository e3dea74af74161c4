#include "report/regress/regress.h"
#include "tests/report/pages/answer.h"
#include "tests/test_files.h"

namespace shadowbench::regress {
namespace {

Comparison make_difference(const std::string& filter) {
  Comparison comparison;
  comparison.scene = "cubes";
  comparison.filter = comparison.label = filter;
  comparison.settings = "view main, map 512, 256 x 144";
  comparison.add(Outcome::kLessAccurate, {"error.rmse", 0.1, 0.2, 0.01, "RMSE is 0.2, and was 0.1"});
  comparison.notes = {"times are another machine's"};
  comparison.picture = filter + ".png";
  return comparison;
}

RegressReport make_report(std::size_t differing) {
  RegressReport report;
  for (std::size_t i = 0; i < differing; ++i) report.comparisons.push_back(make_difference(fmt::format("filter{}", i)));
  report.comparisons.emplace_back();
  report.accept_command = "shadowbench regress run --accept";
  return report;
}

TEST(RegressPage, SaysWhatTheTerminalSays_WithPictures_InBothFormats) {
  const RegressReport report = make_report(2);
  const std::string terminal = make_regress_text(report);
  const document::Page page = make_regress_page(report);
  for (const std::string& written : {document::write_html(page), document::write_markdown(page), terminal})
    for (const char* part : {"less accurate: cubes filter0 (view main, map 512, 256 x 144)", "RMSE is 0.2, and was 0.1",
                             "note: times are another machine", "filter1.png", "3 compared: 1 same, 2 less accurate",
                             "if this is meant: shadowbench regress run --accept"})
      EXPECT_THAT(written, HasSubstr(part));
  EXPECT_THAT(document::write_html(page), HasSubstr("<img src=\"filter0.png\""));
}

TEST(RegressPage, BeginsWithTheAnswer_WhatMoved_AndByHowMuch) {
  RegressReport report = make_report(2);
  report.comparisons[1].accepted = true;
  report.comparisons.back().scene = "cubes";
  report.comparisons.back().filter = "vsm";
  // A map of another scale is far beyond a limit that means "equal".
  report.comparisons[0].findings.push_back({"map_scale.texel_m", 1.0, 2.0, 1e-9, "another map"});
  const document::Page page = make_regress_page(report);
  EXPECT_EQ(
      document::answer_of(page),
      "3 compared: 1 same, 2 less accurate. Worst: cubes filter0 (view main, map 512, 256 x 144) is less accurate: "
      "RMSE is 0.2, and was 0.1.");
  const auto verdict = [&](const char* filter) { return document::verdict_of(page, "cubes", filter); };
  EXPECT_EQ(verdict("filter0"), std::pair(std::string("\u2717 less accurate, 10 x its limit"), document::Grade::kBad));
  EXPECT_EQ(verdict("filter1"), std::pair(std::string("less accurate, accepted"), document::Grade::kNear));
  EXPECT_EQ(verdict("vsm"), std::pair(std::string("same"), document::Grade::kGood));
}

TEST(RegressPage, ManyCells_AreCounted_AndStandInTheTable) {
  const document::Page page = make_regress_page(make_report(kMostListed + 2));
  EXPECT_THAT(document::write_html(page), AllOf(HasSubstr(fmt::format("id=\"cell-{}\"", kMostListed)),
                                                Not(HasSubstr(fmt::format("id=\"cell-{}\"", kMostListed + 1))),
                                                HasSubstr("2 more cells differ: see regress.json.")));
  EXPECT_EQ(document::verdict_of(page, "cubes", fmt::format("filter{}", kMostListed + 1)).second,
            document::Grade::kBad);
}

TEST(RegressText, InALog_TakesNineLinesAtMost_TheWorstFirst) {
  RegressReport report = make_report(kMostListed + 2);
  report.options.brief = true;
  report.options.out = "now/regress";
  const std::string text = make_regress_text(report);
  EXPECT_LE(std::ranges::count(text, '\n'), 9) << text;
  EXPECT_THAT(text, StartsWith("less accurate: cubes filter0 (view main, map 512, 256 x 144): RMSE is 0.2, "
                               "and was 0.1\n"));
  EXPECT_THAT(text, AllOf(HasSubstr("and 17 more cells: see now/regress/regress.json\n"),
                          HasSubstr("report: now/regress/regress.html\n")));
}

TEST(RegressText, Summary_StandsInTheText_AndNotInTheFailure) {
  const RegressReport report = make_report(2);
  EXPECT_THAT(make_regress_text(report), HasSubstr("3 compared: 1 same, 2 less accurate\n"));
  EXPECT_EQ(
      describe_failure(report),
      "the baseline is not met; the worst: cubes filter0 (view main, map 512, 256 x 144) is less accurate: RMSE is "
      "0.2, and was 0.1");
}

/// The cells of a run and their views' truth, of which there was nothing before.
RegressReport make_new_baseline() {
  RegressReport report;
  for (const char* filter : {"none", "vsm", "truth"}) {
    Comparison& comparison = report.comparisons.emplace_back(make_difference(filter));
    comparison.outcome = Outcome::kExtra;
    comparison.findings = {{.text = "the baseline has no such cell"}};
    comparison.accepted = true;
  }
  report.is_new = report.options.accept = true;
  report.options.baseline = "expected";
  return report;
}

TEST(RegressText, NewBaseline_IsOneLine_ButWhatCouldNotBeAcceptedIsTold) {
  RegressReport report = make_new_baseline();
  EXPECT_EQ(make_regress_text(report), "new baseline of 2 cells and the truth of 1 view: expected\n");
  EXPECT_THAT(document::write_html(make_regress_page(report)),
              AllOf(HasSubstr("new baseline of 2 cells"), Not(HasSubstr("no such cell"))));
  report.comparisons[1].accepted = false;
  EXPECT_THAT(make_regress_text(report), AllOf(HasSubstr("extra: cubes vsm"), HasSubstr("new baseline of 1 cell and")));
}

TEST(RegressJUnit, CasesHaveTheTimesOfTheirCells_AsFarAsTheyAreKnown) {
  RegressReport report = make_report(2);
  for (Comparison& each : report.comparisons) each.scene = "cubes";
  report.comparisons[0].measured_s = 1.25;
  report.comparisons[1].measured_s = 0.5;
  const std::string junit = make_junit(report);
  EXPECT_THAT(junit, AllOf(HasSubstr("failures=\"2\" time=\"1.750\""), HasSubstr("144)\" time=\"1.250\""),
                           HasSubstr("144)\" time=\"0.500\"")));
  EXPECT_THAT(junit, HasSubstr("name=\" ()\" />")) << "the third has none";
}

}  // namespace
}  // namespace shadowbench::regress
