
#include <fmt/format.h>
#include <gmock/gmock.h>

#include "report/regress/regress_text.h"
#include "tests/report/pages/answer.h"

namespace shadowbench::regress {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

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

TEST(RegressPage, WhereAllIsTheSame_NothingIsToBeAccepted) {
  const std::string html = document::write_html(make_regress_page(make_report(0)));
  EXPECT_THAT(html, AllOf(HasSubstr("1 compared: 1 same"), Not(HasSubstr("--accept")), Not(HasSubstr("cell-1"))));
}

TEST(RegressPage, ManyCells_AreCounted_AndStandInTheTable) {
  const document::Page page = make_regress_page(make_report(kMostListed + 2));
  EXPECT_THAT(document::write_html(page), AllOf(HasSubstr(fmt::format("id=\"cell-{}\"", kMostListed)),
                                                Not(HasSubstr(fmt::format("id=\"cell-{}\"", kMostListed + 1))),
                                                HasSubstr("2 more cells differ: see regress.json.")));
  EXPECT_EQ(document::verdict_of(page, "cubes", fmt::format("filter{}", kMostListed + 1)).second,
            document::Grade::kBad);
}

TEST(RegressPage, Texts_AreEscaped) {
  RegressReport report = make_report(1);
  report.comparisons[0].scene = report.comparisons[0].findings[0].text = report.accept_command = "<b>";
  EXPECT_THAT(document::write_html(make_regress_page(report)), Not(HasSubstr("<b>")));
}

}  // namespace
}  // namespace shadowbench::regress
