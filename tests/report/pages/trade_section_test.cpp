#include "report/pages/trade_section.h"

#include <gmock/gmock.h>

#include <cstdlib>
#include <nlohmann/json.hpp>
#include <regex>

#include "report/page/embedded.h"
#include "report/pages/html.h"
#include "report/pages/report.h"
#include "report/records/json_io.h"
#include "tests/report/analysis/trade_cells.h"

namespace shadowbench::pages {

using namespace analysis;
using namespace records;
namespace {

using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::SizeIs;

constexpr const char* kHostile = "</script><script>alert('1', \"2\")</script><!--";

nlohmann::json read_data(const std::string& page) {
  const std::string start = "<script type=\"application/json\" id=\"trade-data\">";
  const auto begin = page.find(start) + start.size();
  return nlohmann::json::parse(page.substr(begin, page.find("</script>", begin) - begin));
}

std::string write_and_read(const TemporaryFolder& folder, const std::vector<records::CellRecord>& cells,
                           const std::string& file) {
  std::vector<std::string> keys;
  for (const records::CellRecord& cell : cells) {
    records::write_cell(folder.path(), cell);
    keys.push_back(cell.key);
  }
  write_report(folder.path(), make_run(), keys);
  return read_text(folder.path() / file);
}

TEST(TradeSection, Data_IsJsonThatHoldsEveryCellAndFront) {
  const auto cells = make_crossing_cells("cubes");
  const std::string page = make_trade_html(make_run(), cells, *make_trade(make_run(), cells));
  const nlohmann::json data = read_data(page);
  ASSERT_THAT(data["scopes"], SizeIs(1));
  const nlohmann::json& scope = data["scopes"][0];
  EXPECT_THAT(scope["configurations"], SizeIs(7));
  EXPECT_EQ(scope["configurations"][0]["costs"][0], nlohmann::json({4, 4, 4}));
  EXPECT_EQ(scope["configurations"][0]["pictures"][0]["picture"], "cubes.none.png");
  EXPECT_TRUE(scope["configurations"][0]["pictures"][0]["visibility"].is_null());
  EXPECT_TRUE(scope["configurations"][0]["errors"][2].is_null());
  const nlohmann::json& front = scope["fronts"][0][0];
  EXPECT_EQ(front["members"], nlohmann::json({0, 1, 4}));
  EXPECT_EQ(front["places"][3][1], "dominated");
  EXPECT_EQ(front["places"][3][2], 1);
  EXPECT_EQ(front["places"][5][1], "tied");
  EXPECT_EQ(front["places"][5][2], 4);
  EXPECT_THAT(front["words"].dump(), HasSubstr("vsm (radius 2)"));
  EXPECT_NEAR(data["charts"][0]["still"]["crossings"][0]["radius"].get<double>(), 3.0, 1e-9);
  EXPECT_THAT(data["costs"][0]["axis"].get<std::string>(), HasSubstr("CPU time (software rasteriser)"));
}

TEST(TradeSection, HostileTexts_EndNoElement) {
  std::vector<records::CellRecord> cells = make_crossing_cells(kHostile);
  for (records::CellRecord& cell : cells) {
    if (cell.filter == "poisson") cell.filter = kHostile;
    cell.params["name"] = std::string(kHostile);
    cell.images.picture = kHostile;
  }
  const std::string page = make_trade_html(make_run(), cells, *make_trade(make_run(), cells));
  EXPECT_THAT(page, Not(HasSubstr("alert('1', \"2\")")));
  EXPECT_THAT(page, Not(HasSubstr("<!--")));
  const std::regex opening("<script"), closing("</script>");
  EXPECT_EQ(std::distance(std::sregex_iterator(page.begin(), page.end(), opening), {}), 3);
  EXPECT_EQ(std::distance(std::sregex_iterator(page.begin(), page.end(), closing), {}), 3);
  EXPECT_EQ(read_data(page)["filters"][1]["id"], kHostile);
  EXPECT_THAT(read_data(page)["scopes"][0]["configurations"][0]["pictures"][0]["picture"].get<std::string>(),
              Not(HasSubstr("<")));
}

TEST(TradeSection, Report_HasEveryFileItLinksTo) {
  const TemporaryFolder folder("trade_report");
  const std::string page = write_and_read(folder, make_crossing_cells("cubes"), "index.html");
  EXPECT_THAT(page, HasSubstr("<h2>The trade: what less error costs</h2>"));
  EXPECT_LT(page.find("id=\"trade\""), page.find("id=\"group-0\""));
  const std::regex links("(?:href|src)=\"((?:plots|chart|fronts)[^\"]*)\"");
  int count = 0;
  for (std::sregex_iterator found(page.begin(), page.end(), links), end; found != end; ++found, ++count)
    EXPECT_TRUE(std::filesystem::exists(folder.path() / (*found)[1].str())) << (*found)[1];
  EXPECT_GE(count, 8);
  EXPECT_EQ(read_text(folder.path() / "chart.min.js"), page::chart_library());
  for (const auto& entry : std::filesystem::directory_iterator(folder.path()))
    EXPECT_NE(entry.path().filename().string().front(), '.');
}

TEST(TradeSection, LoadsNothingFromElsewhere) {
  const auto cells = make_crossing_cells("cubes");
  const std::string page = make_trade_html(make_run(), cells, *make_trade(make_run(), cells));
  EXPECT_THAT(page, Not(HasSubstr("http")));
  EXPECT_THAT(std::string(page::chart_library()), HasSubstr("MIT License"));
  EXPECT_THAT(std::string(page::chart_library()), HasSubstr("Chart.js v3"));
}

/// In a dark page the ink is light, and cannot be read on paper that stays white.
TEST(TradeSection, PaperOfAFixedColour_HasInkOfAFixedColour) {
  const std::string style(page::trade_style());
  const std::regex rules("[{][^{}]*background: #[^{}]*[}]");
  int papers = 0;
  for (std::sregex_iterator found(style.begin(), style.end(), rules), end; found != end; ++found, ++papers)
    EXPECT_THAT(found->str(), HasSubstr(" color: #"));
  EXPECT_EQ(papers, 1);
}

TEST(TradeSection, OfAFewCells_IsNotThere) {
  const TemporaryFolder folder("trade_small");
  const std::string page =
      write_and_read(folder, {make_sweep_cell({}), make_sweep_cell({"cubes", "vsm"})}, "index.html");
  EXPECT_THAT(page, Not(HasSubstr("<script")));
  EXPECT_FALSE(std::filesystem::exists(folder.path() / "chart.min.js"));
  EXPECT_FALSE(std::filesystem::exists(folder.path() / "plots"));
}

TEST(TradeSection, WithoutGnuplot_TheReportIsWrittenAndSaysSo) {
  const TemporaryFolder folder("trade_no_gnuplot");
  const std::string path = std::getenv("PATH");
  setenv("PATH", folder.path().c_str(), 1);
  const std::string page = write_and_read(folder, make_crossing_cells("cubes"), "index.html");
  setenv("PATH", path.c_str(), 1);
  EXPECT_THAT(page, HasSubstr("No plots for documents: gnuplot cannot be started"));
  EXPECT_THAT(page, Not(HasSubstr(".svg")));
  EXPECT_THAT(read_text(folder.path() / "summary.md"), HasSubstr("No plots for documents"));
}

TEST(TradeSection, Summary_SaysFrontsCrossoversAndColumns) {
  const TemporaryFolder folder("trade_summary");
  const std::string summary = write_and_read(folder, make_crossing_cells("cubes"), "summary.md");
  for (const char* text : {"## The trade", "the front from the cheapest cell on: none",
                           "from a kernel radius of 4 texels on", "`dominated_by`:"})
    EXPECT_THAT(summary, HasSubstr(text));
  EXPECT_LT(summary.find("## The trade"), summary.find("### What it costs"));
}

}  // namespace
}  // namespace shadowbench::pages
