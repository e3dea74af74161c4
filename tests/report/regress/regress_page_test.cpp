#include "report/regress/regress_page.h"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include "report/regress/regress_text.h"

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
  comparison.add(Outcome::kLessAccurate, {"rmse", 0.1, 0.2, 0.01, "RMSE is 0.2, and was 0.1"});
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
  const page::Page page = make_regress_page(report);
  for (const std::string& written : {page::write_html(page), page::write_markdown(page), terminal})
    for (const char* part : {"less accurate: cubes filter0 (view main, map 512, 256 x 144)", "RMSE is 0.2, and was 0.1",
                             "note: times are another machine", "filter1.png", "3 compared: 1 same, 2 less accurate",
                             "if this is meant: shadowbench regress run --accept"})
      EXPECT_THAT(written, HasSubstr(part));
  EXPECT_THAT(page::write_html(page), HasSubstr("<img src=\"filter0.png\""));
}

TEST(RegressPage, WhereAllIsTheSame_NothingIsToBeAccepted) {
  const std::string html = page::write_html(make_regress_page(make_report(0)));
  EXPECT_THAT(html, AllOf(HasSubstr("1 compared: 1 same"), Not(HasSubstr("--accept")), Not(HasSubstr("cell-1"))));
}

TEST(RegressPage, ManyCells_AreListedInATable) {
  const std::string html = page::write_html(make_regress_page(make_report(kMostListed + 2)));
  EXPECT_THAT(html, AllOf(HasSubstr(fmt::format("id=\"cell-{}\"", kMostListed)),
                          Not(HasSubstr(fmt::format("id=\"cell-{}\"", kMostListed + 1))),
                          HasSubstr(fmt::format("<td class=\"s\">filter{}</td>", kMostListed + 1))));
}

TEST(RegressPage, Texts_AreEscaped) {
  RegressReport report = make_report(1);
  report.comparisons[0].scene = report.comparisons[0].findings[0].text = report.accept_command = "<b>";
  EXPECT_THAT(page::write_html(make_regress_page(report)), Not(HasSubstr("<b>")));
}

}  // namespace
}  // namespace shadowbench::regress
