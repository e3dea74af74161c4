#include "report/pages/run_page.h"

#include <sys/stat.h>

#include <nlohmann/json.hpp>
#include <regex>

#include "report/analysis/findings.h"
#include "report/images/picture_io.h"
#include "report/pages/grid_sheets.h"
#include "report/pages/tables.h"
#include "report/pages/trade_section.h"
#include "report/pages/write_page.h"
#include "report/records/json_io.h"
#include "tests/report/analysis/trade_cells.h"
#include "tests/report/pages/answer.h"

namespace shadowbench::pages {
namespace {

using namespace analysis;
using namespace records;

std::set<std::string> list_links(const std::string& page) {
  static const std::regex kLink("(?:href|src)=\"([^\"]*)\"");
  std::set<std::string> links;
  for (std::sregex_iterator found(page.begin(), page.end(), kLink), end; found != end; ++found)
    links.insert((*found)[1]);
  return links;
}

// Every tag that opens is closed, in order; what scripts hold is no tag.
void expect_balanced(const std::string& with_scripts) {
  std::string page = with_scripts;
  for (std::size_t at = page.find("<script"); at != std::string::npos; at = page.find("<script", at + 1)) {
    const std::size_t begin = page.find('>', at) + 1;
    page.erase(begin, page.find("</script>", begin) - begin);
  }
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

nlohmann::json read_data(const std::string& page) { return nlohmann::json::parse(read_script(page, "run")); }

std::string make_html(const RunRecord& run, const std::vector<CellRecord>& cells) {
  return document::write_html(make_run_page(run, cells));
}

std::string make_summary(const RunRecord& run, const std::vector<CellRecord>& cells) {
  return document::write_markdown(make_run_page(run, cells));
}

/// Writes the report of some cells, and reads one of its files.
std::string write_and_read(const RunRecord& run, const std::vector<CellRecord>& cells, const std::string& file) {
  const TestFolder folder;
  write_report(folder.path(), run, cells);
  return folder.read(file);
}

CellRecord make_illustrated_cell(const std::string& scene, const std::string& filter) {
  CellRecord cell = make_cell(scene, filter, 4.0);
  cell.images = {scene + "." + filter + ".png", scene + "." + filter + ".visibility.png", scene + ".depth.png",
                 scene + ".grid.png", scene + ".exr"};
  return cell;
}

/// A row of the answer, and words of the configuration for the script that makes it anew.
TEST(RunPage, TheBiasToShip_HasARow_WhereItWasSwept) {
  const std::vector<CellRecord> cells = {make_cell("cubes", "none", 1.0)};
  BiasCell ship;
  ship.scene = "cubes";
  ship.map_size = cells[0].map_size;
  ship.fit = cells[0].fit;
  ship.id = "none";
  ship.params = cells[0].params;
  ship.bias = "plane:texels=1";
  ship.contact_gap = 0.01;
  const auto write = [&] { return document::write_html(make_run_page(make_run(), cells, {ship})); };
  EXPECT_THAT(write(), HasSubstr("bias to ship</td><td>cubes: plane:texels=1, contact gap 1 %"));
  EXPECT_EQ(read_data(write())["configurations"][0]["bias"], "cubes: plane:texels=1, contact gap 1 %");
  ship.map_size *= 2;
  EXPECT_THAT(write(), Not(HasSubstr("bias to ship</td>")));
}

TEST(RunPage, Bars_HaveTheirNumbersAsText) {
  const std::string page = make_html(make_run(), {make_attributed_cell("vsm", 0.04, {0.0, 0.75, -0.25, 0.5}),
                                                  make_attributed_cell("esm", 0.04, {0.0, 0.0, 1.0, 0.0})});
  EXPECT_THAT(page,
              HasSubstr("role=\"img\" aria-label=\"vsm: 0.04 · numeric 0 %, estimator 75 %, discretisation -25 %, "
                        "model 50 %; parts below 0 offset the others\""));
  EXPECT_THAT(page, HasSubstr("in [0,1]; shares add up to 100 %: parts below 0 offset the others<"));
  EXPECT_THAT(page,
              HasSubstr("Parts of the RMSE, to 0.06;"));  // 0.01 to the left, 0.05 to the right of the zero line
  EXPECT_THAT(page, HasSubstr("<rect x=\"167\" y=\"4\" width=\"500\" height=\"16\" fill=\"#f0bf30\">"));
  EXPECT_THAT(page, HasSubstr("discretisation and bias"));
  expect_balanced(page);
}

TEST(RunPage, ASuspectCell_HasNoBar_SinceItWouldSetTheScale) {
  CellRecord cell = make_attributed_cell("mine", 0.04, {0.0, 0.75, -0.25, 0.5});
  EXPECT_THAT(make_html(make_run(), {cell}), HasSubstr("Parts of the RMSE"));
  cell.status = CellStatus::kSuspect;
  EXPECT_THAT(make_html(make_run(), {cell}), Not(HasSubstr("Parts of the RMSE")));
}

TEST(RunPage, BeginsWithFastBalancedAndBest_AndWhy) {
  std::vector<CellRecord> cells;
  for (const auto& [filter, rmse, ms] :
       {std::tuple{"none", 0.09, 1.0}, {"cheap", 0.08, 2.0}, {"knee", 0.05, 3.0}, {"dear", 0.04, 12.0}}) {
    cells.push_back(make_attributed_cell(filter, rmse, {0.0, 0.1, 0.1, 0.8}));
    cells.back().time_ms.moving = OwnTime{{ms, ms, ms, 9}, {ms, ms}};
    cells.back().images.picture = fmt::format("images/{}.png", filter);
    cells.back().images.truth_picture = "images/truth.png";
    cells.back().images.hardest = TileRecord{900, 500, 60, 40};
    cells.back().images.grid = "cubes.grid.png";
    cells.back().error.flip = rmse;
  }
  const std::string page = make_html(make_run(), cells);
  const std::size_t answer = page.find("class=\"answer\"");
  for (const char* text : {"Use cheap. Where shadows must look right, pay 6 times as much for dear.<",
                           "cheap: 2 ms (CPU), RMSE 0.08; the cheapest clearly better than none<",
                           "knee: 3 ms (CPU), RMSE 0.05; 75 % of the quality gain for 10 % of the extra cost<",
                           "dear: 12 ms (CPU), RMSE 0.04; the least RMSE, at 6 times the cost of the fast one<",
                           "<img src=\"cubes.grid.png\" alt=\"filters on cubes by their error\" loading=",
                           "<h2>The trade</h2>", "id=\"evidence\""})
    EXPECT_NE(page.find(text, answer), page.npos) << text;
  EXPECT_LT(page.find("dear: 12"), page.find("<img src=\"cubes.grid.png\""));
  EXPECT_LT(page.find("<img src=\"cubes.grid.png\""), page.find("id=\"table\""));
  EXPECT_LT(page.find("id=\"trade\""), page.find("id=\"evidence\""));
  const nlohmann::json data = read_data(page);
  EXPECT_EQ(data["cells"][1]["values_of"]["error.rmse"], 0.08);
  EXPECT_EQ(data["cells"][1]["part"], nlohmann::json({480, 348, 480, 192}))
      << "about the tile, as far as there is room";
  EXPECT_EQ(data["configurations"][3]["time_ms.moving"], 12.0);
  const nlohmann::json& scope = data["scopes"].at(0);
  EXPECT_EQ(scope["rows"][1]["worst"]["error.rmse"],
            nlohmann::json({{"value", 0.08}, {"limit", 0.08}, {"place", 0}, {"unseen", nlohmann::json::array()}}));
  const nlohmann::json& advice = scope["advice"]["moving"][""];
  EXPECT_EQ(advice["order"][0], nlohmann::json({{"index", 0}, {"tied", nlohmann::json::array()}}));
  EXPECT_TRUE(advice["unjudged"].empty());
  EXPECT_TRUE(scope["advice"]["moving"].contains("medium")) << "as with --class";
  EXPECT_EQ(data["scopes"].size(), 1u) << "one scene is all scenes";
}

TEST(RunPage, AnswersForEachScene_AndSaysWhereTheChoiceDoesNotMatterOrWasNotTested) {
  std::vector<CellRecord> cells;
  for (const auto& [scene, filter, rmse, flip] : {std::tuple{"sun", "none", 0.09, 0.02},
                                                  {"sun", "soft", 0.05, 0.01},
                                                  {"spot", "none", 0.05, 0.02},
                                                  {"spot", "soft", 0.09, 0.03},
                                                  {"dim", "none", 0.2, 0.0002},
                                                  {"dim", "soft", 0.1, 0.0004},
                                                  {"lamp", "none", 0.0, 0.0},
                                                  {"lamp", "soft", 0.0, 0.0}}) {
    cells.push_back(make_attributed_cell(filter, rmse, {0.0, 0.1, 0.1, 0.8}));
    cells.back().scene = scene;
    cells.back().error.flip = flip;
    cells.back().truth.lit = std::string(scene) == "lamp" ? 0 : 100000;
    cells.back().truth.penumbra = std::string(scene) == "lamp" ? 0 : 50000;
    const double ms = std::string(filter) == "none" ? 1.0 : 2.0;
    cells.back().time_ms.moving = OwnTime{{ms, ms, ms, 9}, {ms, ms}};
  }
  const std::string page = make_html(make_run(), cells);
  EXPECT_THAT(page, HasSubstr(">sun</td><td>soft, RMSE 0.05</td>"));
  EXPECT_THAT(page, HasSubstr(">spot</td><td>none, RMSE 0.05</td>"));
  EXPECT_THAT(page, HasSubstr(">dim</td><td>does not matter: every filter&#39;s FLIP is below 0.01 per receiver"));
  EXPECT_THAT(page, HasSubstr(">lamp</td><td>not tested: no receiver in view sees it<"));
  EXPECT_THAT(page, HasSubstr("<p>3 of 4 lights judged; lamp not tested: no receiver in view sees it.</p>"));
  const nlohmann::json data = read_data(page);
  ASSERT_EQ(data["scopes"].size(), 5u);
  EXPECT_EQ(data["scopes"][0]["judged"], "3 of 4 lights judged; lamp not tested: no receiver in view sees it.");
  EXPECT_EQ(data["scopes"][4]["left_out"], "not tested: no receiver in view sees it");
  EXPECT_TRUE(data["scopes"][1]["left_out"].is_null());
  EXPECT_EQ(data["scopes"][0]["rows"][1]["rmse"]["value"], std::sqrt((0.05 * 0.05 + 0.09 * 0.09) / 2.0))
      << "without the scene that does not matter";
}

TEST(RunPage, WithoutErrorsOrTimes_SaysWhatCanBeSaid) {
  EXPECT_THAT(make_summary(make_run(), {make_cell("cubes", "vsm", 4.0)}),
              HasSubstr("vsm: 7.5 ms (CPU); the cheapest "));
  CellRecord untimed = make_attributed_cell("vsm", 0.04, {0.0, 0.1, 0.1, 0.8});
  untimed.time_ms = {};
  EXPECT_THAT(make_summary(make_run(), {untimed}), HasSubstr("Nothing fits: none of 1 configurations can be judged"));
  untimed.teaching = true;
  EXPECT_THAT(make_summary(make_run(), {untimed}), HasSubstr("filters for teaching alone"));
}

TEST(RunPage, SceneWithSeveralMapsAndFits_IsNamedWithEach) {
  std::vector<CellRecord> cells = {make_cell("cubes", "vsm", 4.0), make_cell("cubes", "vsm", 4.0),
                                   make_cell("ball", "vsm", 4.0)};
  cells[1].map_size = 512;
  const std::string page = make_html(make_run(), cells);
  for (const char* link : {"<summary>cubes: Three cubes on a floor, map 1024<",
                           "<summary>cubes: Three cubes on a floor, map 512<", "<summary>ball<"})
    EXPECT_THAT(page, HasSubstr(link));
  cells[1].fit = "view";
  EXPECT_THAT(make_html(make_run(), cells), HasSubstr("<summary>cubes: Three cubes on a floor, map 512, view fit<"));
}

TEST(RunPage, EveryLink_LeadsToAFileOfTheReport) {
  const TestFolder folder;
  std::vector<std::string> keys;
  for (const std::string scene : {"cubes", "we ird#%<scene>?"}) {
    const CellRecord cell = make_illustrated_cell(scene, "vsm");
    for (const auto& path : {cell.images.picture, cell.images.visibility, cell.images.depth_map, cell.images.grid})
      images::write_grey_png(folder.path() / *path, images::Image(2, 2, 1));
    images::write_exr(folder.path() / *cell.images.exr, {{"a", {"Y"}, images::Image(2, 2, 1)}}, {});
    write_cell(folder.path(), cell);
    keys.push_back(cell.key);
  }
  const auto count_files = [&] {
    const std::string page = read_text(folder.path() / "index.html");
    std::set<std::string> there;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder.path()))
      there.insert(encode_url_path(entry.path().lexically_relative(folder.path()).string()));
    std::size_t files = 0;
    for (const std::string& url : list_links(page)) {
      if (url.front() == '#') {
        EXPECT_THAT(page, HasSubstr("id=\"" + url.substr(1) + "\""));
      } else if (url.rfind("data:", 0) != 0) {
        EXPECT_THAT(there, Contains(url));
        ++files;
      }
    }
    for (const nlohmann::json& cell : read_data(page)["cells"])
      EXPECT_THAT(there, Contains(cell["picture"].get<std::string>()));
    return files;
  };
  write_early_report(folder.path(), make_run(), read_cells(folder.path(), {keys.front()}), "1 of 2 scenes");
  EXPECT_THAT(read_text(folder.path() / "index.html"), HasSubstr("1 of 2 scenes"));
  EXPECT_FALSE(has_page(folder.path(), "run")) << "it is not whole";
  EXPECT_GE(count_files(), 3u);
  write_report(folder.path(), make_run(), keys);
  EXPECT_TRUE(has_page(folder.path(), "run"));
  EXPECT_GE(count_files(), 11u);
  write_early_report(folder.path(), make_run(), read_cells(folder.path(), keys), "1 of 3 scenes");
  EXPECT_FALSE(has_page(folder.path(), "run")) << "the page of another run is whole, and this one is not";
}

TEST(RunPage, Page_HoldsWhatTheReportIsOf) {
  RunRecord run = make_run();
  run.warnings = {"something is odd"};
  CellRecord failed = make_cell("cubes", "mine", 4.0);
  failed.status = CellStatus::kCrashed;
  failed.message = "signal 11";
  const std::string page = make_html(run, {make_illustrated_cell("cubes", "vsm"), failed});
  for (const char* text : {"cubes: Three cubes on a floor", "Some CPU", "something is odd", "crashed: signal 11",
                           "CPU time (software rasteriser)", "cubes.grid.png", "cubes.depth.png", "cubes.exr",
                           "timings.csv", "results.json", "no truth in this run", "class=\"scroll\""})
    EXPECT_THAT(page, HasSubstr(text));
}

TEST(RunPage, LargeRun_LeavesTablesOfScenesToTheCsvFiles_AndKeepsPictures) {
  std::vector<CellRecord> cells(kMostCellsInDetail, make_cell("cubes", "vsm", 4.0));
  for (std::size_t i = 0; i < cells.size(); ++i) cells[i].params["radius"] = static_cast<double>(i);
  cells.front().images.grid = "cubes.grid.png";
  EXPECT_THAT(make_summary(make_run(), cells), HasSubstr("What it costs: "));
  cells.push_back(make_cell("cubes", "none", 4.0));
  const std::string summary = make_summary(make_run(), cells);
  EXPECT_THAT(summary, Not(HasSubstr("What it costs: ")));
  EXPECT_THAT(summary, Not(HasSubstr("How wrong it is")));
  EXPECT_THAT(summary, HasSubstr("The run has 2001 cells"));
  EXPECT_THAT(summary, HasSubstr("cubes.grid.png"));
  EXPECT_THAT(summary, HasSubstr("RMSE to the area truth")) << "of all scenes";
}

TEST(Report, OfNoCell_IsWritten) {
  const TestFolder folder;
  write_report(folder.path(), make_run(), std::vector<std::string>{});
  for (const char* name : {"results.json", "results.schema.json", "timings.csv", "summary.md", "index.html"})
    EXPECT_TRUE(std::filesystem::exists(folder.path() / name)) << name;
  expect_balanced(read_text(folder.path() / "index.html"));
}

std::string field(const TextTable& table, std::size_t row, const std::string& column) {
  const auto found = std::find(table.header.begin(), table.header.end(), column);
  EXPECT_NE(found, table.header.end()) << column;
  return table.rows.at(row).at(static_cast<std::size_t>(found - table.header.begin()));
}

CellRecord make_empty() {
  CellRecord empty;
  empty.filter = "mine";
  return empty;
}

TEST(CostTable, Rows_AreAsLongAsTheHeader) {
  const TextTable table = make_cost_table({"cubes", {make_cell("cubes", "vsm", 4.0), make_empty()}}, make_run().gl);
  EXPECT_THAT(table.rows, Each(SizeIs(table.header.size())));
  EXPECT_THAT(table.header, Contains("lookup, ms (CPU), median [quartiles]"));
  EXPECT_THAT(table.rows[0], Contains("4 [3.92, 4.08]"));
  EXPECT_THAT(table.rows[1], Not(Contains(HasSubstr("nan"))));
}

TEST(AccuracyTable, HoldsErrorsPartsAndArtefacts) {
  CellRecord cell = make_attributed_cell("vsm", 0.04, {0.001, 0.71, 0.089, 0.2});
  cell.artefact.acne = 0.0;
  cell.artefact.leak = 0.0421;
  cell.artefact.contact_gap = 0.00012;
  cell.artefact.noise = 0.5;
  cell.rmse_ci95 = Interval{0.03, 0.05};
  const TextTable table = make_accuracy_table({"cubes", {cell}});
  EXPECT_EQ(field(table, 0, "RMSE to the area truth [95 % over phases]"), "0.04 [0.03, 0.05]");
  EXPECT_EQ(field(table, 0, "kernel width (class)"), "0.65 texels (medium)");
  EXPECT_EQ(field(table, 0, "mean signed error"), "-0.005");
  EXPECT_EQ(field(table, 0, "RMSE to the kernel truth, first phase"), "0.02");
  EXPECT_EQ(field(table, 0, "dominating part, first phase"), "estimator 71 %");
  EXPECT_EQ(field(table, 0, "acne, first phase"), "0 %");
  EXPECT_EQ(field(table, 0, "leak, first phase"), "4.21 %");
  EXPECT_EQ(field(table, 0, "contact gap, first phase"), "0.012 %");
  EXPECT_EQ(field(table, 0, "noise, first phase"), "50 %");
  EXPECT_EQ(field(table, 0, "share of numeric / estimator / discretisation / model, first phase"),
            "0 % / 71 % / 9 % / 20 %");
}

TEST(AccuracyTable, WhatDoesNotExist_IsADash) {
  const TextTable table = make_accuracy_table({"cubes", {make_empty(), make_empty()}});
  ASSERT_THAT(table.rows, Each(SizeIs(table.header.size())));
  for (std::size_t i = 1; i < table.header.size(); ++i) EXPECT_EQ(table.rows[0][i], kNothing) << table.header[i];
}

TEST(AccuracyTable, DominatingPart_IsNamedOnlyWhereOneDoes) {
  const TextTable table = make_accuracy_table({"cubes",
                                               {make_attributed_cell("a", 0.04, {0.0, 0.5, 0.1, 0.4}),
                                                make_attributed_cell("b", 0.0005, {0.0, 0.9, 0.1, 0.0})}});
  EXPECT_EQ(field(table, 0, "dominating part, first phase"), "none");
  EXPECT_EQ(field(table, 1, "dominating part, first phase"), "none: within the truth's own error");
}

class WritePage : public ::testing::Test {
 protected:
  /// Writes a page into a folder of the report, and reads its HTML back.
  std::string write(const std::string& folder, const std::string& command) const {
    write_page(report_.path() / folder, command, {"A page", {}, {}});
    return read(folder, command);
  }
  std::string read(const std::string& folder, const std::string& command) const {
    return report_.read(folder + "/" + command + ".html");
  }

  const TestFolder report_;
};

TEST_F(WritePage, LinksThePagesThatLieInTheSameReport) {
  write("bias", "bias");
  report_.write("index.html", "");
  EXPECT_THAT(write("stress", "stress"),
              AllOf(HasSubstr("href=\"../index.html\""), HasSubstr("href=\"../bias/bias.html\""),
                    Not(HasSubstr("href=\"../tune/tune.html\""))));
}

TEST_F(WritePage, LinksPagesThatWereWrittenEarlier_WithTheNewOne) {
  write("bias", "bias");
  EXPECT_THAT(read("bias", "bias"), Not(HasSubstr("stress.html")));
  write("stress", "stress");
  EXPECT_THAT(read("bias", "bias"), HasSubstr("href=\"../stress/stress.html\""));
}

TEST_F(WritePage, LinksNoPipe) {
  std::filesystem::create_directories(report_.path() / "stress");
  ASSERT_EQ(mkfifo((report_.path() / "stress" / "stress.html").c_str(), 0600), 0);
  EXPECT_THAT(write("bias", "bias"), Not(HasSubstr("stress.html")));
}

/// A folder of the user's choice may lie beside somebody else's index.html.
TEST_F(WritePage, LinksNothingOutsideTheReport) {
  report_.write("index.html", "");
  EXPECT_THAT(write("mine", "stress"), Not(HasSubstr("index.html")));
}

// The report of cells that several kinds of machine measured.

/// Whether a text says a number of milliseconds.
bool says_milliseconds(const std::string& text) { return std::regex_search(text, std::regex("[0-9] ms")); }

TEST(MixedMachines, NoTimeIsSaid_ButInTheTablesOfMeasurements) {
  const std::string summary = write_and_read(make_run(), make_mixed_cells(), "details.md");
  EXPECT_FALSE(says_milliseconds(summary)) << summary;
  EXPECT_THAT(summary, HasSubstr("Nothing fits: none of 3 configurations can be judged"));
  EXPECT_THAT(summary, HasSubstr("A fast CPU, 64 cores, A GPU, GPU time (timer query) (1 cell)"));
  EXPECT_THAT(write_and_read(make_run(), make_mixed_cells(), "timings.csv"),
              HasSubstr("\"A fast CPU, 64 cores, A GPU, GPU time (timer query)\""));
  std::vector<CellRecord> alike = make_mixed_cells();
  for (CellRecord& cell : alike) cell.machine = make_kind("A CPU");
  const std::string usual = write_and_read(make_run(), alike, "details.md");
  EXPECT_TRUE(says_milliseconds(usual));
  EXPECT_THAT(usual, Not(HasSubstr("Several kinds")));
}

TEST(MixedMachines, OneWarningSaysSo_AlsoWhereTheReportIsWrittenAgain) {
  RunRecord run = make_run();
  run.warnings = {"another", warn_of_mixed_machines(make_mixed_cells())};
  const auto results = nlohmann::json::parse(write_and_read(run, make_mixed_cells(), "results.json"));
  EXPECT_THAT(results["warnings"], ElementsAre(warn_of_mixed_machines(make_mixed_cells()), "another"));
  EXPECT_FALSE(results["cells"][2]["time_ms"]["moving"].is_null()) << "records keep what was measured";
}

}  // namespace
}  // namespace shadowbench::pages
