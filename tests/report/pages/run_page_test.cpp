#include "report/pages/run_page.h"

#include <gmock/gmock.h>

#include <regex>
#include <set>

#include "report/images/picture_io.h"
#include "report/pages/write_report.h"
#include "report/records/json_io.h"
#include "tests/report/records/synthetic.h"

namespace shadowbench::pages {

using namespace records;
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

std::set<std::string> list_links(const std::string& page) {
  static const std::regex kLink("(?:href|src)=\"([^\"]*)\"");
  std::set<std::string> links;
  for (std::sregex_iterator found(page.begin(), page.end(), kLink), end; found != end; ++found)
    links.insert((*found)[1]);
  return links;
}

std::string decode_url(const std::string& url) {
  std::string text;
  for (std::size_t i = 0; i < url.size(); ++i) {
    if (url[i] == '%') {
      text += static_cast<char>(std::stoi(url.substr(i + 1, 2), nullptr, 16));
      i += 2;
    } else {
      text += url[i];
    }
  }
  return text;
}

// Every tag that opens is closed, in order.
void expect_balanced(const std::string& page) {
  static const std::regex kTag("<(/?)([a-z0-9]+)[^>]*>");
  static const std::set<std::string> kVoid = {"meta", "link", "img"};
  std::vector<std::string> open;
  for (std::sregex_iterator found(page.begin(), page.end(), kTag), end; found != end; ++found) {
    const std::string name = (*found)[2];
    if (kVoid.count(name) != 0) continue;
    if ((*found)[1].length() == 0) {
      open.push_back(name);
    } else {
      ASSERT_FALSE(open.empty()) << name;
      ASSERT_EQ(open.back(), name);
      open.pop_back();
    }
  }
  EXPECT_TRUE(open.empty());
}

std::string make_html(const records::RunRecord& run, const std::vector<records::CellRecord>& cells) {
  return page::write_html(make_run_page(run, cells, make_trade(cells)));
}

std::string make_summary(const records::RunRecord& run, const std::vector<records::CellRecord>& cells) {
  return page::write_markdown(make_run_page(run, cells, make_trade(cells)));
}

records::CellRecord make_illustrated_cell(const std::string& scene, const std::string& filter) {
  records::CellRecord cell = make_cell(scene, filter, 4.0);
  cell.images = {scene + "." + filter + ".png",
                 scene + "." + filter + ".visibility.png",
                 scene + ".depth.png",
                 scene + ".grid.png",
                 scene + ".exr",
                 scene + "." + filter + ".attribution.png"};
  return cell;
}

TEST(RunPage, HostileNames_AreEscaped) {
  records::CellRecord cell = make_illustrated_cell("<script>alert('1', \"2\")</script>", "\"><img src=x onerror=y>");
  cell.status = records::CellStatus::kError;
  cell.message = "</td></table><b>";
  cell.params["<i>"] = std::string("&lt;");
  records::RunRecord run = make_run();
  run.warnings = {"<u>"};
  run.gl.renderer = "<s>";
  const std::string page = make_html(run, {cell});
  for (const char* tag : {"<script", "<img src=x", "\"2\"", "<b>", "<i>", "<u>", "<s>"})
    EXPECT_THAT(page, Not(HasSubstr(tag)));
  EXPECT_THAT(page, HasSubstr("&lt;script&gt;alert(&#39;1&#39;, &quot;2&quot;)"));
  expect_balanced(page);
}

TEST(RunPage, Bars_HaveTheirNumbersAsText) {
  const std::string page = make_html(make_run(), {make_attributed_cell("vsm", 0.04, {0.0, 0.75, -0.25, 0.5}),
                                                  make_attributed_cell("esm", 0.04, {0.0, 0.0, 1.0, 0.0})});
  EXPECT_THAT(page,
              HasSubstr("role=\"img\" aria-label=\"vsm: RMSE 0.04 · numeric 0 %, estimator 75 %, discretisation -25 %, "
                        "model 50 %\""));
  EXPECT_THAT(page, HasSubstr("the full width 0.06"));  // 0.01 to the left, 0.05 to the right of the zero line
  EXPECT_THAT(page, HasSubstr("<rect x=\"167\" y=\"4\" width=\"500\" height=\"16\" fill=\"#f0bf30\">"));
  EXPECT_THAT(page, HasSubstr("discretisation and bias"));
  expect_balanced(page);
}

TEST(RunPage, BarsLength_IsWrittenWithoutRoundingErrors) {
  const records::CellRecord cell = make_attributed_cell("vsm", 0.3, {0.0, 1.0, 0.0, 0.0});
  EXPECT_THAT(make_html(make_run(), {cell}), HasSubstr("the full width 0.3.<"));
}

TEST(RunPage, WithoutAttribution_ThereAreNoBarsOrAReason) {
  EXPECT_THAT(make_html(make_run(), {make_cell("cubes", "vsm", 4.0)}), Not(HasSubstr("<figure class=\"bars\"")));
  records::CellRecord without = make_attributed_cell("mine", 0.03, {});
  without.attribution = {};
  without.absent["attribution"] = "<no> model";
  const records::CellRecord with = make_attributed_cell("vsm", 0.04, {0.0, 0.75, -0.25, 0.5});
  const std::string page = make_html(make_run(), {with, without});
  EXPECT_THAT(page, HasSubstr("RMSE 0.03 · no attribution: &lt;no&gt; model"));
  expect_balanced(page);
}

TEST(RunPage, HostileNamesInBarsAndPictures_AreEscaped) {
  records::CellRecord cell = make_attributed_cell("\"><script>", 0.04, {0.0, 0.75, -0.25, 0.5});
  cell.images.attribution = "images/\"><script>.png";
  const std::string page = make_html(make_run(), {cell});
  EXPECT_THAT(page, Not(HasSubstr("<script")));
  EXPECT_THAT(page, HasSubstr("&quot;&gt;&lt;script&gt;: the error and its four parts"));
  expect_balanced(page);
}

TEST(RunPage, SceneWithSeveralMaps_IsNamedWithEach) {
  std::vector<records::CellRecord> cells = {make_cell("cubes", "vsm", 4.0), make_cell("cubes", "vsm", 4.0),
                                            make_cell("ball", "vsm", 4.0)};
  cells[1].map_size = 512;
  const std::string page = make_html(make_run(), cells);
  for (const char* link :
       {"cubes: Three cubes on a floor, map 1024</a>", "cubes: Three cubes on a floor, map 512</a>", ">ball</a>"})
    EXPECT_THAT(page, HasSubstr(link));
}

TEST(RunPage, Page_LoadsNothingFromElsewhere) {
  const std::string page = make_html(make_run(), {make_illustrated_cell("cubes", "vsm")});
  for (const std::string& url : list_links(page))
    EXPECT_THAT(url, Not(::testing::AnyOf(HasSubstr("//"), ::testing::StartsWith("/")))) << url;
  EXPECT_THAT(page, Not(HasSubstr("@import")));
  EXPECT_THAT(page, Not(HasSubstr("url(")));
  EXPECT_THAT(page, HasSubstr("prefers-color-scheme: dark"));
  expect_balanced(page);
}

TEST(RunPage, EveryLink_LeadsToAFileOfTheReport) {
  const TemporaryFolder folder("html_links");
  std::vector<std::string> keys;
  for (const std::string scene : {"cubes", "we ird#%<scene>?"}) {
    const records::CellRecord cell = make_illustrated_cell(scene, "vsm");
    for (const auto& path : {cell.images.picture, cell.images.visibility, cell.images.depth_map, cell.images.grid,
                             cell.images.attribution})
      images::write_grey_png(folder.path() / *path, images::Image(2, 2, 1));
    images::write_exr(folder.path() / *cell.images.exr, {{"a", {"Y"}, images::Image(2, 2, 1)}}, {});
    records::write_cell(folder.path(), cell);
    keys.push_back(cell.key);
  }
  write_report(folder.path(), make_run(), keys);
  const std::string page = read_text(folder.path() / "index.html");
  std::size_t files = 0;
  for (const std::string& url : list_links(page)) {
    if (url.front() == '#') {
      EXPECT_THAT(page, HasSubstr("id=\"" + url.substr(1) + "\""));
    } else if (url.rfind("data:", 0) != 0) {
      EXPECT_TRUE(std::filesystem::exists(folder.path() / decode_url(url))) << url;
      ++files;
    }
  }
  EXPECT_EQ(files, 17u);
}

TEST(RunPage, Page_HoldsWhatTheReportIsOf) {
  records::RunRecord run = make_run();
  run.warnings = {"something is odd"};
  records::CellRecord failed = make_cell("cubes", "mine", 4.0);
  failed.status = records::CellStatus::kCrashed;
  failed.message = "signal 11";
  const std::string page = make_html(run, {make_illustrated_cell("cubes", "vsm"), failed});
  for (const char* text :
       {"cubes: Three cubes on a floor", "Some CPU", "something is odd", "crashed: signal 11",
        "CPU time (software rasteriser)", "cubes.grid.png", "cubes.depth.png", "cubes.exr", "cubes.vsm.attribution.png",
        "timings.csv", "results.json", "no truth in this run", "class=\"scroll\""})
    EXPECT_THAT(page, HasSubstr(text));
}

TEST(SummaryMd, HoldsTheRunTheTablesAndTheReasons) {
  records::RunRecord run = make_run();
  run.warnings = {"something is odd"};
  const std::string summary = make_summary(run, {make_cell("cubes", "vsm", 4.5), make_cell("stack", "vsm", 4.5)});
  for (const char* text : {"Some CPU", "llvmpipe", "All times are CPU time (software rasteriser)", "## cubes",
                           "## stack", "| vsm ", "something is odd", "error: no truth in this run (2 of 2 cells)",
                           "**lookup_median_ms**: filtered lookup", "Debian GNU/Linux 12", "40 passes run"})
    EXPECT_THAT(summary, HasSubstr(text));
}

TEST(SummaryMd, Names_CannotBreakTheTable) {
  records::CellRecord cell = make_cell("a|b", "x|y", 4.0);
  cell.message = "line 1\nline 2 | 3";
  cell.status = records::CellStatus::kError;
  EXPECT_THAT(make_summary(make_run(), {cell}), HasSubstr("| x\\|y "));
  EXPECT_THAT(make_summary(make_run(), {cell}), HasSubstr("line 1 line 2 \\| 3 |"));
}

TEST(SummaryMd, HasATableOfCostsAndOneOfErrors) {
  const std::string summary = make_summary(make_run(), {make_attributed_cell("vsm", 0.04, {0.001, 0.71, 0.089, 0.2})});
  for (const char* text : {"What it costs: CPU time", "How wrong it is, and why", "| estimator 71 % ",
                           "**estimator_share**:", "5 truths ray traced", "Most of the error of vsm"})
    EXPECT_THAT(summary, HasSubstr(text));
}

TEST(Report, OfNoCell_IsWritten) {
  const TemporaryFolder folder("report_empty");
  write_report(folder.path(), make_run(), {});
  for (const char* name : {"results.json", "results.schema.json", "timings.csv", "summary.md", "index.html"})
    EXPECT_TRUE(std::filesystem::exists(folder.path() / name)) << name;
  expect_balanced(read_text(folder.path() / "index.html"));
}

}  // namespace
}  // namespace shadowbench::pages
