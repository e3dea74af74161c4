#include "report/pages/bias_page.h"

#include <gmock/gmock.h>

#include <regex>

#include "report/pages/bias_chart.h"

namespace shadowbench::page {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;

const std::vector<double> kFactors = {0.0, 0.125, 0.25, 0.5, 1.0, 2.0, 4.0, 8.0};

/// Acne goes to nothing at `enough`, contact opens from theory on.
records::BiasCurve make_curve(const std::string& filter, double enough) {
  records::BiasCurve curve{filter, 0.5, 0.01, 2.0, 0.4, {}};
  for (const double factor : kFactors)
    curve.points.push_back({factor, factor * 0.5, factor < enough ? 0.25 : 0.0, factor > 1.0 ? 0.5 : 0.01});
  return curve;
}

records::BiasSweepRecord make_sweep() {
  records::BiasSweepRecord sweep;
  sweep.scene = "steps";
  sweep.filters = {"none", "pcf2x2"};
  sweep.acne_receivers = 5000;
  sweep.contact_receivers = 300;
  sweep.fewest_receivers = 100;
  sweep.modes.push_back({"constant",
                         "depth",
                         "One depth.",
                         {make_curve("none", 1.0), make_curve("pcf2x2", 0.5)},
                         {},
                         "bias.constant.png",
                         "pictures"});
  records::BiasModeRecord fixed{"midpoint", "", "Half-way.", {}, {}, {}, {}};
  fixed.curves.push_back({"none", 0, 0, 0, 0, {{std::nullopt, 0.0, 0.125, std::nullopt}}});
  sweep.modes.push_back(fixed);
  return sweep;
}

void make_gap_absent(records::BiasSweepRecord& sweep) {
  for (records::BiasCurve& curve : sweep.modes[0].curves)
    for (records::BiasPoint& point : curve.points) point.contact_gap.reset();
}

TEST(BiasChart, Factors_AreEquallyFarApart_AndRatesBySquareRoot) {
  const pages::ChartPoint first = pages::place_in_chart(kFactors, 0.0, 0.0),
                          second = pages::place_in_chart(kFactors, 0.125, 0.0);
  const pages::ChartPoint last = pages::place_in_chart(kFactors, 8.0, 1.0),
                          quarter = pages::place_in_chart(kFactors, 8.0, 0.25);
  EXPECT_NEAR(last.x - first.x, 7.0 * (second.x - first.x), 1e-9);
  EXPECT_GT(second.x, first.x);
  EXPECT_LT(last.y, first.y);
  EXPECT_NEAR(first.y - quarter.y, 0.5 * (first.y - last.y), 1e-9);
}

TEST(BiasChart, Svg_HasEachNumberAtItsPixel) {
  const records::BiasSweepRecord sweep = make_sweep();
  const std::string svg = pages::make_bias_chart(sweep.modes[0], sweep.filters);
  const pages::ChartPoint dark = pages::place_in_chart(kFactors, 0.5, 0.25);
  char text[64];
  std::snprintf(text, sizeof text, "cx=\"%.1f\" cy=\"%.1f\"", dark.x, dark.y);
  EXPECT_THAT(svg, HasSubstr(text));
  std::snprintf(text, sizeof text, "x1=\"%.1f\"", pages::place_in_chart(kFactors, 1.0, 0.0).x);
  EXPECT_THAT(svg, HasSubstr(text));
  EXPECT_THAT(svg, HasSubstr(">theory<"));
}

/// All numbers of one attribute of an SVG.
std::vector<double> list_attribute(const std::string& svg, const std::string& name) {
  const std::regex pattern(" " + name + "=\"(-?[0-9.]+)\"");
  std::vector<double> values;
  for (std::sregex_iterator found(svg.begin(), svg.end(), pattern), end; found != end; ++found)
    values.push_back(std::stod((*found)[1]));
  return values;
}

TEST(BiasChart, EverythingLiesWithinTheDrawing) {
  records::BiasSweepRecord sweep = make_sweep();
  sweep.modes[0].curves[0].points[0].acne = 1.0;
  const std::string svg = pages::make_bias_chart(sweep.modes[0], sweep.filters);
  for (const char* name : {"x", "cx", "x1", "x2"})
    EXPECT_THAT(list_attribute(svg, name), ::testing::Each(::testing::AllOf(::testing::Ge(0.0), ::testing::Le(480.0))));
  for (const char* name : {"y", "cy", "y1", "y2"})
    EXPECT_THAT(list_attribute(svg, name), ::testing::Each(::testing::AllOf(::testing::Ge(0.0), ::testing::Le(300.0))));
}

TEST(BiasChart, FactorNames_AreFractions) {
  std::vector<std::string> names;
  for (const double factor : kFactors) names.push_back(pages::name_factor(factor));
  EXPECT_THAT(names, ElementsAre("0", "1/8", "1/4", "1/2", "1", "2", "4", "8"));
}

TEST(BiasChart, AbsentRates_HaveNoMarks_AndAreSaid) {
  records::BiasSweepRecord sweep = make_sweep();
  EXPECT_THAT(pages::make_bias_chart(sweep.modes[0], sweep.filters), HasSubstr("curve gap"));
  make_gap_absent(sweep);
  const std::string svg = pages::make_bias_chart(sweep.modes[0], sweep.filters);
  EXPECT_THAT(svg, HasSubstr("contact gap: absent"));
  EXPECT_THAT(svg, Not(HasSubstr("curve gap")));
  EXPECT_THAT(svg, Not(HasSubstr("acne: absent")));
}

TEST(BiasPage, Enough_IsTheSmallestAmountWithoutAcne) {
  EXPECT_EQ(pages::find_enough(make_curve("a", 0.5)), 0.5);
  EXPECT_EQ(pages::find_enough(make_curve("a", 0.0)), 0.0);
  EXPECT_EQ(pages::find_enough(make_curve("a", 100.0)), std::nullopt);
}

TEST(BiasPage, Words_FollowFromNumbers) {
  records::BiasModeRecord mode = make_sweep().modes[0];
  mode.curves.push_back(make_curve("vsm", 0.0));
  mode.curves.push_back(make_curve("esm", 100.0));
  const auto words = pages::describe_bias_mode(mode);
  ASSERT_EQ(words.size(), 2u);
  EXPECT_THAT(words[0], HasSubstr("below 0.1 %"));
  EXPECT_THAT(words[0],
              HasSubstr("none needs 1; pcf2x2 needs 1/2; vsm needs none; esm has more at every amount swept."));
  EXPECT_THAT(words[1], HasSubstr("acne lies between 0 % (none) and 25 % (esm); contact gap is 1 %."));
}

TEST(BiasPage, AbsentRates_AreSaid_NeverNumbers) {
  records::BiasSweepRecord sweep = make_sweep();
  make_gap_absent(sweep);
  sweep.contact_receivers = 7;
  const std::string page = pages::make_bias_html(sweep);
  EXPECT_THAT(page, HasSubstr("contact gap is absent"));
  EXPECT_THAT(page, HasSubstr("Absent: a rate needs 100."));
  EXPECT_THAT(page, Not(HasSubstr("nan")));
  EXPECT_THAT(pages::describe_bias_mode(sweep.modes[1]), ElementsAre());
}

TEST(BiasPage, Texts_AreEscaped) {
  records::BiasSweepRecord sweep = make_sweep();
  sweep.scene = "<i>\"&";
  sweep.title = "<u>";
  sweep.filters[0] = sweep.modes[0].curves[0].filter = "<b>'x'";
  sweep.modes[0].meaning = sweep.modes[0].picture_caption = "a < b";
  sweep.modes[0].left_out = {"<s>"};
  const std::string page = pages::make_bias_html(sweep);
  for (const char* raw : {"<i>", "<u>", "<b>", "<s>", "a < b"}) EXPECT_THAT(page, Not(HasSubstr(raw)));
  EXPECT_THAT(page, HasSubstr("&lt;b&gt;&#39;x&#39;"));
}

TEST(BiasPage, LoadsNothingButItsPictures) {
  const std::string page = pages::make_bias_html(make_sweep());
  EXPECT_THAT(page, HasSubstr("src=\"bias.constant.png\""));
  EXPECT_THAT(page, Not(HasSubstr("http")));
  EXPECT_THAT(page, HasSubstr("prefers-color-scheme: dark"));
}

TEST(BiasPage, Csv_HasARowPerAmount_AbsentIsEmpty) {
  records::BiasSweepRecord sweep = make_sweep();
  sweep.modes[0].curves[1].filter = "poisson (taps 8, radius 2)";
  const std::string csv = pages::make_bias_csv(sweep);
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 1 + 16 + 1);
  EXPECT_THAT(csv, HasSubstr("steps,,0,constant,depth,none,0.5,0.25,0.005,1,0.2,0.25,0.01\r\n"));
  EXPECT_THAT(csv, HasSubstr("\"poisson (taps 8, radius 2)\""));
  EXPECT_THAT(csv, HasSubstr("steps,,0,midpoint,,none,,,,,,0.125,\r\n"));
}

}  // namespace
}  // namespace shadowbench::page
