#include <gmock/gmock.h>

#include <regex>

#include "report/page/embedded.h"
#include "report/page/markdown.h"
#include "tests/report/page/example_page.h"

namespace shadowbench::page {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

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
                           "<caption>A table</caption>",
                           "<div class=\"gallery wide\">",
                           "<img src=\"images/a%20b.png\" alt=\"a picture\" loading=\"lazy\">",
                           "<rect x=\"200\" y=\"4\" width=\"600\" height=\"16\" fill=\"#f0bf30\">",
                           "<li>mine: no attribution</li>",
                           "<figure class=\"chart\" id=\"choice\">",
                           "<figure class=\"chart\" id=\"single\">",
                           "<li>The sentence of a</li>",
                           "<details><summary>More</summary>"})
    EXPECT_THAT(html, HasSubstr(text));
}

TEST(Page, Markdown_SaysTheSame_InColumnsThatLineUp) {
  const std::string text = write_markdown(make_example_page());
  for (const char* part :
       {"# An \\<example\\>", "Other pages: [the run](../index.html)", "- **machine**: a_b & c",
        "## Warnings\n\nMind:\n\n- something is odd", "Data: [a b.csv](a%20b.csv), [its schema](c.json)",
        "#### A heading", "A table:\n\n", "| vsm    | 0.25 | short ", "| a\\|b   | –    | xxx",
        "Pictures: [a picture](images/a%20b.png)", "- vsm: RMSE 0.03", "one for every scene and cost",
        "### More\n\n#### Within\n\nunfolded"})
    EXPECT_THAT(text, HasSubstr(part));
}

TEST(Page, WithoutCharts_HasNoScript) {
  const Page page{"t", {{"a", "A", {Paragraph{"text"}}}}, {}};
  EXPECT_THAT(write_html(page), Not(HasSubstr("<script")));
}

TEST(Page, LoadsNothingFromElsewhere) {
  const std::string html = write_html(make_example_page());
  EXPECT_THAT(html, Not(HasSubstr("@import")));
  EXPECT_THAT(html, Not(::testing::ContainsRegex("(src|href)=\"(http|//)")));
}

TEST(Page, StyleSheet_KnowsDarkScreensPhonesAndPaper) {
  const std::string style(page_style());
  for (const char* media : {"prefers-color-scheme: dark", "max-width: 600px", "@media print"})
    EXPECT_THAT(style, HasSubstr(media));
}

TEST(Markdown, EscapesWhatMeansSomething) {
  EXPECT_EQ(escape_markdown("a|b\n<c> `d` *e* [f]_g"), "a\\|b \\<c\\> \\`d\\` \\*e\\* \\[f\\]\\_g");
  EXPECT_EQ(escape_markdown("kernel_rmse _x"), "kernel_rmse \\_x");
}

}  // namespace
}  // namespace shadowbench::page
