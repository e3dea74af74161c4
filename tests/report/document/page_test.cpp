#include "report/document/chart.h"
#include "report/document/embedded.h"
#include "report/document/markdown.h"
#include "tests/report/pages/answer.h"
#include "tests/test_files.h"

namespace shadowbench::document {
namespace {

analysis::Estimate about(double value, double slack = 0.0) {
  return {value, value * (1.0 - slack), value * (1.0 + slack)};
}

/// A chart with everything that a chart can have: both kinds of axes, all lines and marks, whiskers, crowded labels,
/// details, cells to open, a point outside the axes, and names that need escaping.
Chart make_example_chart(const std::string& id) {
  Chart chart{id, "Cost & error of <all> filters", "time of the lookup, ms", "RMSE \"to\" the truth", {}, {}, {}, {}};
  chart.x = {true, 0.5, 16.0, {{1.0, "1"}, {2.0, "2"}, {4.0, "4"}, {8.0, "8"}}};
  chart.y = {false, 0.0, 0.1, {{0.0, "0"}, {0.05, "0.05"}, {0.1, "0.1"}}};
  ChartSeries line{"front", "#1c1f24", Mark::kNone, true, false, LineStyle::kSteps, false, {}};
  ChartSeries points{"vsm <b>", "#0072b2", Mark::kDiamond, true, false, LineStyle::kDashed, true, {}};
  ChartSeries beaten{"", "#0072b2", Mark::kSquare, false, true, LineStyle::kNone, true, {}};
  for (int i = 0; i < 6; ++i) {
    const double x = 1.0 + 0.02 * i, y = 0.06 - 0.001 * i;
    line.points.push_back({about(x), about(y), "label " + std::to_string(i + 1)});
    points.points.push_back({about(x, 0.3), about(y, 0.01), {}, {"a detail & more " + std::to_string(i)}});
    points.points.back().opens = "0123456789abcdef";
    beaten.points.push_back({about(2.0 + i), about(0.09)});
  }
  points.points.push_back({about(100.0), about(0.05)});
  ChartSeries ties{"",    "#0072b2",        Mark::kNone, true,
                   false, LineStyle::kTies, false,       {{about(1.0), about(0.06)}, {about(2.0), about(0.09)}}};
  ChartSeries late{"late", "#0072b2",         Mark::kSquare, true,
                   false,  LineStyle::kSolid, false,         {{about(3.0), about(0.03)}}};
  late.hidden = true;
  chart.series = {line, points, beaten, ties, late};
  chart.notes = {"1: vsm (radius 4), map 512",
                 "a note that is so long that it does not fit into one line of a chart on a phone"};
  return chart;
}

/// A page with every kind of block.
Page make_example_page() {
  ChartChoice choice{"choice", {{"scene", {"cubes", "stack"}}, {"cost", {"time", "bytes"}}}, {}};
  for (const char* name : {"a", "b", "c", "d"})
    choice.charts.push_back(make_example_chart(std::string("example.") + name));
  Bars bars{"Where the error comes from",
            {{"#f0bf30", "estimator"}},
            -0.01,
            0.04,
            {{"vsm: RMSE 0.03", {{0.0, 0.03, "#f0bf30"}}, 0.03}, {"mine: no attribution", {}}}};
  Page page{"An <example>", {}, {{"../index.html", "the run"}}};
  page.sections = {
      {{}, {}, {Facts{{{"machine", "a_b & c"}}}, Links{"Data:", {{"a b.csv", "a b.csv"}, {"c.json", "its schema"}}}}},
      {"warnings", "Warnings", {Sentences{"Mind:", {"something is odd"}}}, true},
      {"all",
       "Everything",
       {Heading{"A heading"}, Paragraph{"quiet", true},
        Table{"A table", {{"filter", "rmse", "text"}, {{"vsm", "0.25", "short"}, {"a|b", "–", std::string(60, 'x')}}}},
        Table{"Graded",
              {{"scene", "vsm", "esm"}, {{"cubes", "1", "3"}, {"stack", "2", "–"}}},
              {{Grade::kNone, Grade::kGood, Grade::kBad}, {Grade::kNone, Grade::kNear}}},
        Gallery{"Pictures", {{"images/a b.png", "a picture"}}, true}, bars, choice, make_example_chart("single"),
        Details{"More", {Heading{"Within"}, Paragraph{"unfolded"}}}}}};
  return page;
}

TEST(Page, Html_HasEveryBlock_Escaped) {
  const std::string html = write_html(make_example_page());
  for (const char* text : {"<title>An &lt;example&gt;</title>",
                           "<nav class=\"siblings\"><a href=\"../index.html\">the run</a>",
                           "<a href=\"#warnings\">Warnings</a>",
                           "<section id=\"warnings\" class=\"warns\">",
                           "<dt>machine</dt><dd>a_b &amp; c</dd>",
                           "<p>Data: <a href=\"a%20b.csv\">a b.csv</a>, <a href=\"c.json\">its schema</a></p>",
                           "<p>Mind:</p>",
                           "<li>something is odd</li>",
                           "<h3>A heading</h3>",
                           "<p class=\"note\">quiet</p>",
                           "<td class=\"n\">0.25</td>",
                           "<td class=\"s\">vsm</td>",
                           "<td class=\"n good\">1</td><td class=\"n bad\">\u2717 3</td></tr>",
                           "<td class=\"n near\">2</td>",
                           "<caption>A table</caption>",
                           "<div class=\"gallery wide\">",
                           "<img src=\"images/a%20b.png\" alt=\"a picture\" loading=\"lazy\">",
                           "<rect x=\"200\" y=\"4\" width=\"600\" height=\"16\" fill=\"#f0bf30\">",
                           "<li><span>mine: no attribution</span></li>",
                           "<figure class=\"chart\" id=\"choice\">",
                           "<figure class=\"chart\" id=\"single\">",
                           "<details><summary>More</summary>"})
    EXPECT_THAT(html, HasSubstr(text));
}

TEST(Page, Markdown_SaysTheSame_InColumnsThatLineUp) {
  const std::string text = write_markdown(make_example_page());
  for (const char* part :
       {"# An \\<example\\>", "Other pages: [the run](../index.html)", "- **machine**: a_b & c",
        "## Warnings\n\nMind:\n\n- something is odd", "Data: [a b.csv](a%20b.csv), [its schema](c.json)",
        "#### A heading", "A table:\n\n", "| vsm    | 0.25 | short ", "| a\\|b   | –    | xxx",
        "| cubes | 1   | \u2717 3 |", "| stack | 2   | –   |", "Pictures: [a picture](images/a%20b.png)",
        "- vsm: RMSE 0.03", "one for every scene and cost", "### More\n\n#### Within\n\nunfolded"})
    EXPECT_THAT(text, HasSubstr(part));
}

TEST(Page, WithoutCharts_HasNoScript) {
  const Page page{"t", {{"a", "A", {Paragraph{"text"}}}}, {}};
  EXPECT_THAT(write_html(page), Not(HasSubstr("<script")));
}

TEST(Page, LoadsNothingFromElsewhere) {
  const std::string html = write_html(make_example_page());
  EXPECT_THAT(html, Not(HasSubstr("@import")));
  EXPECT_THAT(html, Not(ContainsRegex("(src|href)=\"(http|//)")));
}

/// Relative luminance of "#rrggbb" (WCAG 2.1).
double luminance_of(const std::string& color) {
  double sum = 0.0;
  const double weights[] = {0.2126, 0.7152, 0.0722};
  for (std::size_t i = 0; i < 3; ++i) {
    const double part = std::stoi(color.substr(1 + 2 * i, 2), nullptr, 16) / 255.0;
    sum += weights[i] * (part <= 0.04045 ? part / 12.92 : std::pow((part + 0.055) / 1.055, 2.4));
  }
  return sum;
}

TEST(Page, GradedCells_CanBeRead_OnLightAndDarkScreens) {
  const std::string style(page_style());
  for (const std::size_t begin : {style.find(":root"), style.find(":root", style.find(":root") + 1)}) {
    const auto color = [&](const std::string& name) {
      return luminance_of(style.substr(style.find("#", style.find("--" + name + ":", begin)), 7));
    };
    const double ink = color("ink");
    for (const char* grade : {"good", "near", "bad"}) {
      const double other = color(grade);
      const auto [dark, light] = std::minmax(ink, other);
      EXPECT_GE((light + 0.05) / (dark + 0.05), 4.5) << grade;
    }
  }
}

TEST(Table, WhatWasSaidFirst_Stays_AndWhatWasNotSaidIsNothing) {
  Table table{"A table", {{"scene"}, {}}};
  table.judge("cubes", "vsm", "2", Grade::kBad);
  table.judge("stack", "esm", "1", Grade::kGood);
  table.judge("cubes", "vsm", "3", Grade::kGood);
  EXPECT_THAT(table.table.header, ElementsAre("scene", "vsm", "esm"));
  EXPECT_EQ(table.text_at(0, 1), "\u2717 2");
  EXPECT_EQ(table.text_at(0, 2), "–");
  EXPECT_EQ(table.grade_at(0, 2), Grade::kNone);
  EXPECT_EQ(table.text_at(1, 2), "1");
}

TEST(Chart, ShowsTheCurvesThatSayMost_AndSaysHowToSeeTheOthers) {
  Chart chart;
  std::vector<std::pair<double, std::string>> weights;
  for (int i = 0; i < 8; ++i) {
    chart.series.emplace_back().title = std::string(1, static_cast<char>('a' + i));
    weights.emplace_back(i == 0 ? 100.0 : i, chart.series.back().title);
  }
  chart.series.emplace_back().title = "bound";
  show_most_telling(chart, weights);
  EXPECT_THAT(list_shown(chart), ElementsAre("a", "d", "e", "f", "g", "h", "bound"));
  EXPECT_THAT(chart.notes, Contains(HasSubstr("click a name")));
  Chart few;
  show_most_telling(few, {{1.0, "a"}});
  EXPECT_TRUE(few.notes.empty());
}

TEST(Markdown, EscapesWhatMeansSomething) {
  EXPECT_EQ(escape_markdown("a|b\n<c> `d` *e* [f]_g"), "a\\|b \\<c\\> \\`d\\` \\*e\\* \\[f\\]\\_g");
  EXPECT_EQ(escape_markdown("kernel_rmse _x"), "kernel_rmse \\_x");
  EXPECT_EQ(write_markdown({"a\x1b[31mb", {}, {}}), "# a\\x1b\\[31mb\n\n");
}

TEST(ChartAxis, IsLogarithmic_WhereValuesArePositiveAndFarApart) {
  const ChartAxis log = choose_axis({0.02, 0.2}, {-0.1, 0.3}, TickKind::kNumber);
  EXPECT_TRUE(log.log);
  EXPECT_GT(log.low, 0.0);
  EXPECT_GT(log.high, 0.3);
  EXPECT_THAT(log.ticks, Contains(std::pair<double, std::string>(0.1, "0.1")));
  EXPECT_FALSE(choose_axis({0.0, 0.2}, {}, TickKind::kNumber).log);
  EXPECT_FALSE(choose_axis({1.0, 1.1}, {}, TickKind::kNumber).log);
}

TEST(ChartAxis, HoldsItsTicks_WithZeroWrittenPlainly) {
  for (const auto& values : {std::vector{0.0, 1.0}, std::vector{0.03, 7.0}, std::vector{5.0, 5.0},
                             std::vector{0.0, 0.0}, std::vector{1e-5, 1e5}}) {
    const ChartAxis axis = choose_axis(values, {}, TickKind::kNumber);
    EXPECT_THAT(axis.ticks, Not(IsEmpty()));
    EXPECT_LE(axis.ticks.size(), 12u);
    for (const auto& [value, label] : axis.ticks) {
      EXPECT_GE(value, axis.low);
      EXPECT_LE(value, axis.high * (1.0 + 1e-9));
      EXPECT_NE(label, "-0");
    }
    EXPECT_LT(axis.low, values[0]);
    EXPECT_GT(axis.high, values[1]);
  }
}

TEST(ChartAxis, ForcedToRatios_HasTicksInANarrowRangeToo) {
  const ChartAxis axis = choose_log_axis({5.0, 5.1}, {});
  EXPECT_TRUE(axis.log);
  EXPECT_GE(axis.ticks.size(), 2u);
  EXPECT_TRUE(choose_log_axis({5.0}, {}).log);
}

TEST(ChartAxis, BytesAreInPowersOfTwo) {
  const ChartAxis axis = choose_axis({262144.0, 8388608.0}, {}, TickKind::kBytes);
  EXPECT_EQ(axis.ticks.front().second, "256 KiB");
  EXPECT_EQ(axis.ticks.back().second, "8 MiB");
}

TEST(ChartStyle, NeighboursDiffer_InColourAndShape) {
  for (std::size_t i = 0; i + 1 < 12; ++i) {
    EXPECT_STRNE(style_of(i).color, style_of(i + 1).color);
    EXPECT_NE(style_of(i).mark, style_of(i + 1).mark);
  }
}

}  // namespace
}  // namespace shadowbench::document
